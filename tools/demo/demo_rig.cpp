#include "tools/demo/demo_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include "tools/demo/surface_nets.h"

namespace sunder::tools {
namespace {
constexpr double kPi = std::numbers::pi;

// ---- Shape: limbs are chains of capsules, blended together

struct Limb {
  std::vector<Vec3d> axis;  ///< Of the capsules, end to end, from the root outwards.
  double radius;
  int ribs;
  /// Perpendicular to all of `axis`: the direction in which the angle around it is zero.
  Vec3d side;
};

const std::vector<Limb>& limbs() {
  static const std::vector<Limb> all = {
      {{{0, 0.22, 0}, {0, 1.62, 0}}, 0.17, 9, {0, 0, -1}},
      {{{0, 0.86, 0}, {-0.38, 0.94, 0}, {-0.43, 1.40, 0}}, 0.095, 6, {0, 0, -1}},
      {{{0, 1.08, 0}, {0.35, 1.14, 0}, {0.41, 1.56, 0}}, 0.088, 6, {0, 0, -1}},
      {{{0, 0.62, 0}, {0, 0.67, 0.30}, {0, 0.86, 0.34}}, 0.07, 6, {-1, 0, 0}},
  };
  return all;
}

/// A position relative to a limb.
struct LimbPlace {
  double distance;  ///< To the axis.
  double along;     ///< Along the axis, from its beginning, metres.
  double angle;     ///< Around the axis.
  double radial;    ///< Distance to the infinite axis; zero at the poles of the caps.
};

LimbPlace place_on(const Limb& limb, const Vec3d& position) {
  LimbPlace nearest{1e30, 0, 0, 0};
  double begin = 0;
  for (std::size_t i = 0; i + 1 < limb.axis.size(); ++i) {
    const Vec3d segment = limb.axis[i + 1] - limb.axis[i];
    const double length = segment.norm();
    const Vec3d direction = segment / length;
    const Vec3d offset = position - limb.axis[i];
    const double along = std::clamp(offset.dot(direction), 0.0, length);
    const double distance = (offset - along * direction).norm();
    if (distance < nearest.distance) {
      const Vec3d radial = offset - offset.dot(direction) * direction;
      nearest = {distance, begin + along,
                 std::atan2(radial.dot(direction.cross(limb.side)), radial.dot(limb.side)),
                 radial.norm()};
    }
    begin += length;
  }
  return nearest;
}

double limb_field(const Limb& limb, const Vec3d& position) {
  const LimbPlace place = place_on(limb, position);
  const double towards_pole = std::min(1.0, place.radial / limb.radius);
  const double ribs = 0.05 * towards_pole * towards_pole * std::cos(limb.ribs * place.angle);
  return place.distance - limb.radius * (1 + ribs);
}

/// Minimum of two fields with a round fillet of about `width` between them.
double melt(double a, double b, double width) {
  const double h = std::max(0.0, 1 - std::abs(a - b) / width);
  return std::min(a, b) - 0.25 * h * h * width;
}

double cactus_field(const Vec3d& position) {
  double field = limb_field(limbs()[0], position);
  for (std::size_t i = 1; i < limbs().size(); ++i)
    field = melt(field, limb_field(limbs()[i], position), 0.09);
  return field;
}

// ---- Bones

struct BoneLine {
  const char* name;
  Index parent;
  Vec3d head, tail;  ///< Model space, at rest.
  double reach;      ///< Radius of the flesh around it.
};

const std::vector<BoneLine>& bone_lines() {
  static const std::vector<BoneLine> all = {
      {"Root", kNone, {0, 0, 0}, {0, 0.22, 0}, 0.17},
      {"Trunk1", 0, {0, 0.22, 0}, {0, 0.60, 0}, 0.17},
      {"Trunk2", 1, {0, 0.60, 0}, {0, 0.95, 0}, 0.17},
      {"Trunk3", 2, {0, 0.95, 0}, {0, 1.28, 0}, 0.17},
      {"Trunk4", 3, {0, 1.28, 0}, {0, 1.62, 0}, 0.17},
      {"Left1", 2, {-0.12, 0.885, 0}, {-0.38, 0.94, 0}, 0.095},
      {"Left2", 5, {-0.38, 0.94, 0}, {-0.405, 1.17, 0}, 0.095},
      {"Left3", 6, {-0.405, 1.17, 0}, {-0.43, 1.40, 0}, 0.095},
      {"Right1", 3, {0.12, 1.10, 0}, {0.35, 1.14, 0}, 0.088},
      {"Right2", 8, {0.35, 1.14, 0}, {0.38, 1.35, 0}, 0.088},
      {"Right3", 9, {0.38, 1.35, 0}, {0.41, 1.56, 0}, 0.088},
      {"Front1", 2, {0, 0.64, 0.12}, {0, 0.67, 0.30}, 0.07},
      {"Front2", 11, {0, 0.67, 0.30}, {0, 0.86, 0.34}, 0.07},
  };
  return all;
}

constexpr Index kRoot = 0;

Skeleton make_skeleton() {
  Skeleton skeleton;
  for (const BoneLine& line : bone_lines()) {
    const Vec3d parent_head =
        line.parent == kNone ? Vec3d(Vec3d::Zero()) : bone_lines()[line.parent].head;
    BoneTransform rest;
    rest.translation = (line.head - parent_head).cast<float>();
    skeleton.bones.push_back({line.name, line.parent, rest});
  }
  return skeleton;
}

Affine3f bone_from_bind(Index bone) {
  Affine3f result = Affine3f::Identity();
  result.translation() = -bone_lines()[bone].head.cast<float>();
  return result;
}

/// Weights fall with the fourth power of the distance to the bones, in radii of their flesh. Small
/// weights fade to zero, so that influences are smooth and few.
std::vector<Influence> influences_at(const Vec3d& position) {
  std::vector<double> shares;
  for (const BoneLine& line : bone_lines()) {
    const Vec3d direction = line.tail - line.head;
    const double t =
        std::clamp((position - line.head).dot(direction) / direction.squaredNorm(), 0.0, 1.0);
    const double squared_ratio =
        (position - line.head - t * direction).squaredNorm() / (line.reach * line.reach);
    shares.push_back(1 / (squared_ratio * squared_ratio + 1e-6));
  }
  const double largest = *std::max_element(shares.begin(), shares.end());
  double sum = 0;
  for (double& share : shares) {
    share = std::max(0.0, share / largest - 0.03);
    sum += share;
  }
  std::vector<Influence> influences;
  for (Index bone = 0; bone < shares.size(); ++bone)
    if (const auto weight = static_cast<float>(shares[bone] / sum); weight > 0.0f)
      influences.push_back({bone, weight});
  std::stable_sort(influences.begin(), influences.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  return influences;
}

// ---- Mesh "Cactus"

constexpr Index kFlesh = 0, kFlower = 1;

/// The caps of the limbs.
bool is_flower(const Vec3d& position) {
  return std::any_of(limbs().begin(), limbs().end(), [&](const Limb& limb) {
    const Vec3d outwards = (limb.axis.back() - limb.axis[limb.axis.size() - 2]).normalized();
    const Vec3d offset = position - limb.axis.back();
    return offset.norm() < 1.2 * limb.radius && offset.dot(outwards) > 0.55 * limb.radius;
  });
}

std::size_t nearest_limb(const Vec3d& position) {
  const auto field_at = [&](const Limb& limb) { return limb_field(limb, position); };
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < limbs().size(); ++i)
    if (field_at(limbs()[i]) < field_at(limbs()[nearest])) nearest = i;
  return nearest;
}

/// Texture coordinates of the corners of a triangle: each limb is unrolled on its own strip.
std::array<Vec2f, 3> unroll(const std::array<Vec3d, 3>& corners) {
  const Vec3d centre = (corners[0] + corners[1] + corners[2]) / 3;
  const std::size_t limb = nearest_limb(centre);
  const double middle = place_on(limbs()[limb], centre).angle;
  std::array<Vec2f, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const LimbPlace place = place_on(limbs()[limb], corners[i]);
    double angle = place.angle;
    // At the seam a corner stays on the side of its triangle, so that no triangle spans the whole
    // strip.
    if (angle - middle > kPi) angle -= 2 * kPi;
    if (middle - angle > kPi) angle += 2 * kPi;
    const double u =
        (static_cast<double>(limb) + 0.5 + 0.4 * angle / kPi) / static_cast<double>(limbs().size());
    result[i] = Vec2d(u, 1 - place.along / 1.7).cast<float>();
  }
  return result;
}

Vec3d swell_at(const Vec3d& position, const Vec3d& normal) {
  const double height = (position.y() - 0.75) / 0.30;
  const double off_axis = std::hypot(position.x(), position.z()) / 0.26;
  return 0.06 * std::exp(-height * height - std::pow(off_axis, 6)) * normal;
}

// ---- Colours, linear RGBA

const Vec4f kClayColor(0.50f, 0.17f, 0.075f, 1), kSoilColor(0.055f, 0.035f, 0.022f, 1);

/// Green, lighter towards the tips; a pink flower.
Vec4f color_at(const Vec3d& position) {
  if (is_flower(position)) return {0.80f, 0.13f, 0.33f, 1};
  const float young = static_cast<float>(std::clamp((position.y() - 0.4) / 1.4, 0.0, 1.0));
  return {0.06f + 0.07f * young, 0.20f + 0.16f * young, 0.06f + 0.03f * young, 1};
}

Mesh make_flesh(Index skin) {
  constexpr double kCell = 0.0265;
  const PointSurface surface =
      surface_nets(cactus_field, Vec3d(-0.62, 0.0, -0.24), Vec3d(0.60, 1.86, 0.50), kCell);

  Mesh mesh;
  mesh.name = "Cactus";
  mesh.skin = skin;
  mesh.submeshes = {{"Flesh", kNone}, {"Flower", kNone}};
  mesh.uv_sets.resize(1);
  mesh.color_sets.resize(1);
  mesh.morph_targets.push_back({"Swell", {}, {}, {}});

  // One vertex per point and texture coordinate; copies along a seam agree in everything else.
  std::map<std::tuple<Index, float, float>, Index> vertex_at;
  for (const Triangle& points : surface.triangles) {
    const std::array<Vec3d, 3> corners = {
        surface.positions[points[0]], surface.positions[points[1]], surface.positions[points[2]]};
    const std::array<Vec2f, 3> uvs = unroll(corners);
    Triangle triangle = {};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [entry, is_new] =
          vertex_at.try_emplace({points[i], uvs[i].x(), uvs[i].y()}, mesh.vertex_count());
      triangle[i] = entry->second;
      if (!is_new) continue;
      const Vec3d normal = field_normal(cactus_field, corners[i]);
      mesh.positions.push_back(corners[i].cast<float>());
      mesh.normals.push_back(normal.cast<float>().normalized());
      mesh.uv_sets[0].push_back(uvs[i]);
      mesh.color_sets[0].push_back(color_at(corners[i]));
      mesh.weights.append(influences_at(corners[i]));
      mesh.morph_targets[0].position_deltas.push_back(swell_at(corners[i], normal).cast<float>());
    }
    mesh.triangles.push_back(triangle);
    mesh.triangle_submesh.push_back(is_flower((corners[0] + corners[1] + corners[2]) / 3) ? kFlower
                                                                                          : kFlesh);
  }
  return mesh;
}

// ---- Mesh "Pot"

Mesh make_pot(Index skin) {
  // Radius and height of the outline of revolution, from the bottom of the axis to its top. Each
  // piece is a band with hard edges.
  constexpr std::array<std::array<double, 2>, 8> kOutline = {{{0, 0},
                                                              {0.22, 0},
                                                              {0.28, 0.26},
                                                              {0.31, 0.26},
                                                              {0.31, 0.34},
                                                              {0.27, 0.34},
                                                              {0.26, 0.28},
                                                              {0, 0.28}}};
  constexpr Index kSegments = 32;
  constexpr Index kSoil = 1;

  Mesh mesh;
  mesh.name = "Pot";
  mesh.skin = skin;
  mesh.submeshes = {{"Clay", kNone}, {"Soil", kNone}};
  mesh.uv_sets.resize(1);
  mesh.color_sets.resize(1);
  for (std::size_t band = 0; band + 1 < kOutline.size(); ++band) {
    const Index first = mesh.vertex_count();
    const double rise = kOutline[band + 1][1] - kOutline[band][1],
                 run = kOutline[band + 1][0] - kOutline[band][0];
    for (Index i = 0; i <= kSegments; ++i) {
      // The last column has the bits of the first one, but its own texture coordinates.
      const double angle = 2 * kPi * (i % kSegments) / kSegments;
      for (const std::size_t end : {band, band + 1}) {
        const double radius = kOutline[end][0];
        mesh.positions.push_back(
            Vec3d(radius * std::sin(angle), kOutline[end][1], radius * std::cos(angle))
                .cast<float>());
        mesh.normals.push_back(
            Vec3d(rise * std::sin(angle), -run, rise * std::cos(angle)).cast<float>().normalized());
        mesh.uv_sets[0].emplace_back(static_cast<float>(i) / kSegments,
                                     1.0f - static_cast<float>(end) / kOutline.size());
        mesh.color_sets[0].push_back(band + 2 == kOutline.size() ? kSoilColor : kClayColor);
        const Influence all_of_root{0, 1.0f};
        mesh.weights.append({&all_of_root, 1});
      }
    }
    for (Index i = 0; i < kSegments; ++i) {
      const Index a = first + 2 * i, b = a + 1, c = a + 2, d = a + 3;
      const auto append = [&](const Triangle& triangle) {
        mesh.triangles.push_back(triangle);
        mesh.triangle_submesh.push_back(band + 2 == kOutline.size() ? kSoil : 0);
      };
      if (kOutline[band][0] > 0) append({a, c, b});
      if (kOutline[band + 1][0] > 0) append({b, c, d});
    }
  }
  return mesh;
}

// ---- Clip "Sway"

Channel make_sway(Index bone, const Vec3d& axis, double amplitude, double phase) {
  Channel channel;
  channel.target = ChannelTarget::rotation;
  channel.index = bone;
  channel.width = 4;
  for (int key = 0; key <= 8; ++key) {
    channel.times.push_back(0.25f * static_cast<float>(key));
    const double angle = amplitude * std::sin(2 * kPi * (key % 8) / 8 + phase);
    const Quatd rotation(Eigen::AngleAxisd(angle, axis));
    for (int i = 0; i < 4; ++i) channel.values.push_back(static_cast<float>(rotation.coeffs()[i]));
  }
  return channel;
}

/// Breathing flesh: a smooth curve through three keys, flat at each key.
Channel make_swelling(Index first_morph_weight) {
  Channel channel;
  channel.target = ChannelTarget::morph_weights;
  channel.index = first_morph_weight;
  channel.width = 1;
  channel.interpolation = Interpolation::cubic_spline;
  channel.times = {0.0f, 1.0f, 2.0f};
  channel.values = {0, 0.0f, 0, 0, 1.0f, 0, 0, 0.0f, 0};
  return channel;
}

Clip make_clip() {
  const Vec3d x = Vec3d::UnitX(), z = Vec3d::UnitZ();
  Clip clip;
  clip.name = "Sway";
  clip.duration = 2.0f;
  clip.channels = {make_sway(1, z, 0.05, 0.0),
                   make_sway(2, z, 0.09, -0.3),
                   make_sway(3, z, 0.12, -0.6),
                   make_sway(4, z, 0.14, -0.9),
                   make_sway(5, z, 0.10, 0.5),
                   make_sway(6, z, 0.18, 0.2),
                   make_sway(7, z, 0.24, -0.1),
                   make_sway(8, z, 0.10, 2.0),
                   make_sway(9, z, 0.18, 1.7),
                   make_sway(10, z, 0.24, 1.4),
                   make_sway(11, x, 0.15, 1.0),
                   make_sway(12, x, 0.30, 0.6),
                   make_swelling(0)};
  return clip;
}

}  // namespace

Character make_cactus() {
  Character character;
  character.name = "Cactus";
  character.skeleton = make_skeleton();
  Skin flesh{"Cactus", {}, {}};
  for (Index bone = 0; bone < character.skeleton.bones.size(); ++bone) {
    flesh.bones.push_back(bone);
    flesh.bone_from_bind.push_back(bone_from_bind(bone));
  }
  character.skins = {flesh, {"Pot", {kRoot}, {bone_from_bind(kRoot)}}};
  character.meshes = {make_flesh(0), make_pot(1)};
  character.rest_morph_weights = {0.0f};
  character.meshes[1].first_morph_weight = 1;
  character.clips = {make_clip()};
  return character;
}

}  // namespace sunder::tools
