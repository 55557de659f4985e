#include "support/models/rigs.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "skinning/internal/reference.h"

namespace sunder::test {
namespace {

void add_chain(Character& character, std::uint32_t bone_count, const Vec3f& step) {
  Skin skin;
  skin.name = "skin";
  for (std::uint32_t i = 0; i < bone_count; ++i) {
    Bone bone;
    bone.name = "bone" + std::to_string(i);
    bone.parent = i == 0 ? kNone : i - 1;
    if (i > 0) bone.rest.translation = step;
    character.skeleton.bones.push_back(bone);
    skin.bones.push_back(i);
    Affine3f bone_from_bind = Affine3f::Identity();
    bone_from_bind.translation() = -static_cast<float>(i) * step;
    skin.bone_from_bind.push_back(bone_from_bind);
  }
  character.skins.push_back(skin);
}

/// Weights of a chain whose bones start at 0, 1, 2 …: smooth, up to four per vertex.
std::vector<Influence> chain_influences(double along, std::uint32_t bone_count) {
  std::vector<std::pair<double, std::uint32_t>> raw;
  for (std::uint32_t i = 0; i < bone_count; ++i) {
    const double distance = std::abs(along - (i + 0.5));
    if (distance < 2.0) raw.emplace_back(std::pow(1.0 - distance / 2.0, 2), i);
  }
  std::sort(raw.rbegin(), raw.rend());
  if (raw.size() > 4) raw.resize(4);
  double sum = 0;
  for (const auto& [weight, bone] : raw) sum += weight;
  std::vector<Influence> influences;
  for (const auto& [weight, bone] : raw)
    if (weight > 0) influences.push_back({bone, static_cast<float>(weight / sum)});
  return influences;
}

}  // namespace

Character make_sheet(std::uint32_t cells, float size) {
  Character character;
  character.name = "sheet";
  add_chain(character, 2, {size / 2, 0, 0});
  Mesh mesh;
  mesh.name = "sheet";
  mesh.uv_sets.emplace_back();
  mesh.submeshes.push_back({"cloth", kNone});
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(cells),
                  v = static_cast<float>(j) / static_cast<float>(cells);
      mesh.positions.emplace_back(size * u, size * v, 0.0f);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      mesh.uv_sets[0].emplace_back(u, v);
      const auto influences = u <= 0.0f   ? std::vector<Influence>{{0, 1.0f}}
                              : u >= 1.0f ? std::vector<Influence>{{1, 1.0f}}
                                          : std::vector<Influence>{{0, 1.0f - u}, {1, u}};
      mesh.weights.append(influences);
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character.meshes.push_back(mesh);
  return character;
}

Blade down_at(double x, double y) { return {{x, y, 0.5}, {x, y, -0.5}}; }

Character make_tube(std::uint32_t rings, std::uint32_t sides, std::uint32_t bone_count) {
  Character character;
  character.name = "tube";
  add_chain(character, bone_count, {0, 1, 0});
  character.rest_morph_weights = {0.0f};

  Mesh mesh;
  mesh.name = "tube";
  mesh.uv_sets.emplace_back();
  mesh.submeshes = {{"side", kNone}, {"caps", kNone}};
  MorphTarget swell{"swell", {}, {}, {}};
  const auto add_vertex = [&](double angle, double radius, double height, const Vec3f& normal,
                              const Vec2f& uv) {
    const Vec3f around(static_cast<float>(std::cos(angle)), 0,
                       static_cast<float>(-std::sin(angle)));
    mesh.positions.push_back(static_cast<float>(radius) * around +
                             Vec3f(0, static_cast<float>(height), 0));
    mesh.normals.push_back(normal);
    mesh.uv_sets[0].push_back(uv);
    mesh.weights.append(chain_influences(height, bone_count));
    swell.position_deltas.push_back(static_cast<float>(radius * 0.3) * around);
    return mesh.vertex_count() - 1;
  };
  const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c,
                                std::uint32_t submesh) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_submesh.push_back(submesh);
  };
  const auto angle_at = [&](std::uint32_t side) {
    return 2 * std::numbers::pi * (side % sides) / sides;
  };
  const auto height_at = [&](std::uint32_t ring) {
    return static_cast<double>(bone_count) * ring / rings;
  };
  constexpr double kRadius = 0.5;

  for (std::uint32_t ring = 0; ring <= rings; ++ring)
    for (std::uint32_t side = 0; side <= sides;
         ++side) {  // the last column repeats the first: the seam
      const double angle = angle_at(side);
      add_vertex(angle, kRadius, height_at(ring),
                 {static_cast<float>(std::cos(angle)), 0, static_cast<float>(-std::sin(angle))},
                 {static_cast<float>(side) / static_cast<float>(sides),
                  static_cast<float>(ring) / static_cast<float>(rings)});
    }
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = ring * (sides + 1) + side, b = a + 1, c = a + sides + 1, d = c + 1;
      add_triangle(a, b, d, 0);
      add_triangle(a, d, c, 0);
    }
  for (const bool top : {false, true}) {
    const double height = top ? height_at(rings) : 0;
    const Vec3f normal(0, top ? 1.0f : -1.0f, 0);
    const std::uint32_t center = add_vertex(0, 0, height, normal, {0.5f, 0.5f});
    const std::uint32_t rim = center + 1;
    for (std::uint32_t side = 0; side < sides; ++side)
      add_vertex(angle_at(side), kRadius, height, normal,
                 {static_cast<float>(0.5 + 0.5 * std::cos(angle_at(side))),
                  static_cast<float>(0.5 + 0.5 * std::sin(angle_at(side)))});
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t a = rim + side, b = rim + (side + 1) % sides;
      top ? add_triangle(center, a, b, 1) : add_triangle(center, b, a, 1);
    }
  }
  mesh.morph_targets.push_back(swell);
  character.meshes.push_back(mesh);

  Clip bend{"Bend", 2.0f, {}};
  for (std::uint32_t bone = 1; bone < bone_count; ++bone) {
    Channel channel;
    channel.target = ChannelTarget::rotation;
    channel.index = bone;
    channel.width = 4;
    channel.times = {0.0f, 1.0f, 2.0f};
    const auto half = static_cast<float>(0.5 * 1.2 / bone_count);
    channel.values = {0, 0, 0, 1, std::sin(half), 0, 0, std::cos(half), 0, 0, 0, 1};
    bend.channels.push_back(channel);
  }
  character.clips.push_back(bend);
  return character;
}

void rig_along(Character& character, std::uint32_t bone_count) {
  Eigen::AlignedBox3f box;
  for (const Mesh& mesh : character.meshes)
    for (const Vec3f& position : mesh.positions) box.extend(Eigen::Vector3f(position));
  Eigen::Index axis = 0;
  const float step = box.sizes().maxCoeff(&axis) / static_cast<float>(bone_count);
  character.skeleton = {};
  character.skins.clear();
  character.clips.clear();
  add_chain(character, bone_count, step * Vec3f::Unit(axis));
  const auto begin = static_cast<float>(box.min()[axis]);
  character.skeleton.bones[0].rest.translation = begin * Vec3f::Unit(axis);
  for (Affine3f& bone_from_bind : character.skins[0].bone_from_bind)
    bone_from_bind.translation() -= begin * Vec3f::Unit(axis);
  for (Mesh& mesh : character.meshes) {
    mesh.skin = 0;
    mesh.weights = {};
    for (const Vec3f& position : mesh.positions)
      mesh.weights.append(chain_influences((position[axis] - begin) / step, bone_count));
  }
}

Character make_bumpy_ball(std::uint32_t points) {
  // The faces of an octahedron, each divided into n x n: 4 n^2 + 2 points.
  const auto n = static_cast<int>(std::lround(std::sqrt(std::max(points, 6u) / 4.0)));
  Character character;
  character.name = "ball";
  Mesh mesh;
  mesh.name = "ball";
  mesh.submeshes.push_back({"skin", kNone});
  Random random(8);
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& place) {
    const auto [at, is_new] = known.try_emplace(place, mesh.vertex_count());
    if (!is_new) return at->second;
    Vec3d direction(place[0], place[1], place[2]);
    direction = (direction / direction.norm() + 0.25 / n * random.direction()).eval();
    direction /= direction.norm();
    const double radius = 1 + 0.1 * std::sin(7 * direction.x() + 1) * std::sin(6 * direction.y()) *
                                  std::cos(5 * direction.z());
    mesh.positions.push_back((radius * direction).cast<float>());
    return at->second;
  };
  for (const int x : {1, -1})
    for (const int y : {1, -1})
      for (const int z : {1, -1})
        for (int i = 0; i < n; ++i)
          for (int j = 0; i + j < n; ++j) {
            const auto at = [&](int di, int dj) {
              return vertex({x * (n - i - di - j - dj), y * (i + di), z * (j + dj)});
            };
            const bool is_mirrored = x * y * z < 0;
            const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
              mesh.triangles.push_back(is_mirrored ? Triangle{a, c, b} : Triangle{a, b, c});
            };
            // One after another: arguments of a call are evaluated in any order.
            const std::uint32_t c = at(0, 1), b = at(1, 0), a = at(0, 0);
            add(a, b, c);
            if (i + j + 1 < n) add(b, at(1, 1), c);
          }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character.meshes.push_back(std::move(mesh));
  rig_along(character, 4);
  return character;
}

Character make_two_tubes(std::uint32_t rings, std::uint32_t sides) {
  Character character = make_tube(rings, sides, 3);
  Mesh upper = character.meshes[0];
  Skin skin = character.skins[0];
  upper.name = "upper";
  upper.skin = 1;
  skin.name = "skin of upper";
  for (Vec3f& position : upper.positions) position.y() += 3.0f;
  for (Affine3f& bone_from_bind : skin.bone_from_bind) bone_from_bind.translation().y() -= 1.0f;
  character.skins.push_back(skin);
  character.meshes.push_back(upper);
  return character;
}

void attach_to(Mesh& mesh, std::uint32_t slot) {
  const std::uint32_t count = mesh.vertex_count();
  mesh.weights = SkinWeights();
  const Influence whole{slot, 1.0f};
  for (std::uint32_t vertex = 0; vertex < count; ++vertex) mesh.weights.append({&whole, 1});
}

Character make_block_figure() {
  Character character = make_tube(24, 16, 1);
  character.skeleton.bones[0].name = "trunk";
  attach_to(character.meshes[0], 0);
  const float height = character.meshes[0].positions.back().y();
  for (const auto& [name, move] :
       {std::pair("head", Vec3f(0, height, 0)), std::pair("cube", Vec3f(0.3f, 0.1f, 0))}) {
    Bone bone;
    bone.name = name;
    bone.parent = static_cast<std::uint32_t>(character.skeleton.bones.size() - 1);
    bone.rest.translation = move;
    character.skeleton.bones.push_back(bone);
  }
  Skin& skin = character.skins[0];
  skin.bones.push_back(2);
  Affine3f bone_from_bind = Affine3f::Identity();
  bone_from_bind.translation() = Vec3f(-0.3f, -height - 0.1f, 0);
  skin.bone_from_bind.push_back(bone_from_bind);
  Mesh head = character.meshes[0];
  head.name = "head";
  head.first_morph_weight = static_cast<std::uint32_t>(character.rest_morph_weights.size());
  character.rest_morph_weights.push_back(0.0f);
  for (Vec3f& position : head.positions) position.y() += height + 0.05f;
  attach_to(head, 1);
  character.meshes.push_back(std::move(head));
  return character;
}

Character make_soup(Random& random) {
  Character character = make_tube(2, 3, 3);
  Mesh mesh;
  mesh.name = "soup";
  mesh.submeshes = {{"one", kNone}, {"other", kNone}};
  const std::uint32_t grid = 2 + random.index(3);
  const std::uint32_t vertex_count = 4 + random.index(40);
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    const std::uint32_t z = random.index(grid), y = random.index(grid),
                        x = random.index(grid);  // evaluated in this order by every compiler
    mesh.positions.emplace_back(static_cast<float>(x), static_cast<float>(y),
                                static_cast<float>(z));
    const float weight = 0.25f * static_cast<float>(random.index(5));
    const auto influences = weight == 0.0f ? std::vector<Influence>{{0, 1.0f}}
                            : weight == 1.0f
                                ? std::vector<Influence>{{2, 1.0f}}
                                : std::vector<Influence>{{0, 1.0f - weight}, {2, weight}};
    // Most coincident vertices agree, so that they share a point.
    mesh.weights.append(random.index(4) == 0 ? influences : std::vector<Influence>{{1, 1.0f}});
  }
  const std::uint32_t triangle_count = 1 + random.index(60);
  for (std::uint32_t t = 0; t < triangle_count; ++t) {
    mesh.triangles.push_back(
        {random.index(vertex_count), random.index(vertex_count), random.index(vertex_count)});
    mesh.triangle_submesh.push_back(random.index(2));
  }
  character.meshes = {mesh};
  return character;
}

ModelPose random_pose(const Character& character, Random& random, double angle, double scale) {
  Pose pose = *local_rest_pose(character);
  for (BoneTransform& bone : pose.parent_from_bone) {
    const Quatd turn(Eigen::AngleAxisd{random.uniform(-angle, angle), random.direction()});
    bone.rotation = Quatf((bone.rotation.cast<double>() * turn).normalized().cast<float>());
    for (int axis = 0; axis < 3; ++axis)
      bone.scale[axis] *= static_cast<float>(std::pow(scale, random.uniform(-1, 1)));
  }
  for (float& weight : pose.morph_weights) weight = static_cast<float>(random.uniform(0, 1));
  ModelPose result;
  if (!compute_model_pose(character.skeleton, pose, result)) std::abort();
  return result;
}

std::vector<Vec3d> posed_positions(const Character& character, std::uint32_t mesh,
                                   const ModelPose& pose) {
  const Mesh& of = character.meshes[mesh];
  std::vector<Affine3d> palette(character.skins[of.skin].bones.size());
  if (!compute_palette(character.skins[of.skin], pose, palette)) std::abort();
  std::vector<Vec3d> positions;
  for (std::uint32_t v = 0; v < of.vertex_count(); ++v)
    positions.push_back(deform_position_reference(of, v, palette, pose.morph_weights));
  return positions;
}

double enclosed_volume(const std::vector<Vec3d>& positions,
                       const std::vector<Triangle>& triangles) {
  double volume = 0;
  for (const Triangle& triangle : triangles)
    volume +=
        positions[triangle[0]].dot(Vec3d(positions[triangle[1]].cross(positions[triangle[2]]))) / 6;
  return volume;
}

double posed_diagonal(const Character& character, const ModelPose& pose) {
  Eigen::AlignedBox3d box;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (const Vec3d& position : posed_positions(character, mesh, pose))
      box.extend(Eigen::Vector3d(position));
  return box.diagonal().norm();
}

Stroke random_stroke(const Character& character, const ModelPose& pose, Random& random,
                     double length, std::uint32_t segments) {
  const double diagonal = posed_diagonal(character, pose);
  for (;;) {
    const std::uint32_t mesh = random.index(static_cast<std::uint32_t>(character.meshes.size()));
    const Mesh& of = character.meshes[mesh];
    if (of.triangles.empty()) continue;
    const Triangle triangle = of.triangles[random.index(of.triangle_count())];
    const auto positions = posed_positions(character, mesh, pose);
    const Vec3d a = positions[triangle[0]], b = positions[triangle[1]], c = positions[triangle[2]];
    const Vec3d cross = (b - a).cross(c - a);
    if (!(cross.norm() > 1e-12 * diagonal * diagonal)) continue;
    const Vec3d normal = cross / cross.norm();
    const double u = random.uniform(0.1, 0.5), v = random.uniform(0.1, 0.4);
    Vec3d at = (1 - u - v) * a + u * b + v * c;
    Vec3d along = random.direction();
    along = along - along.dot(normal) * normal;
    if (along.norm() < 0.1) continue;
    along /= along.norm();
    Stroke stroke;
    const double height = 0.1 * diagonal, depth = 0.05 * diagonal,
                 step = length * diagonal / segments;
    for (std::uint32_t i = 0; i <= segments; ++i) {
      stroke.push_back({at + height * normal, at - depth * normal});
      at += step * along;
      along = Eigen::AngleAxisd(random.uniform(-0.4, 0.4), Eigen::Vector3d(normal)) *
              Eigen::Vector3d(along);
    }
    return stroke;
  }
}

}  // namespace sunder::test
