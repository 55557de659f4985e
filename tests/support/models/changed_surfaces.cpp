#include "support/models/changed_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "pipeline/validation/match/bind_surface.h"

namespace sunder::test {
namespace {

/// The weighted mean of some vertices' influences, as floats that sum to one.
std::vector<Influence> mean_influences(const Mesh& mesh, const std::vector<Index>& vertices) {
  std::map<Index, double> of_slot;
  double sum = 0;
  for (const Index vertex : vertices)
    for (const Influence& influence : mesh.weights.of(vertex)) {
      of_slot[influence.slot] += static_cast<double>(influence.weight);
      sum += static_cast<double>(influence.weight);
    }
  std::vector<Influence> influences;
  for (const auto& [slot, weight] : of_slot)
    influences.push_back({slot, static_cast<float>(weight / sum)});
  return influences;
}

/// A mesh without vertices and triangles that keeps names, skin and submeshes.
Mesh empty_copy(const Mesh& mesh) {
  Mesh copy;
  copy.name = mesh.name;
  copy.skin = mesh.skin;
  copy.submeshes = mesh.submeshes;
  return copy;
}

Mesh subdivided(const Mesh& mesh) {
  Mesh result = mesh;
  result.normals.clear();
  result.tangents.clear();
  result.uv_sets.clear();
  result.color_sets.clear();
  result.custom_attributes.clear();
  for (MorphTarget& target : result.morph_targets) {
    target.normal_deltas.clear();
    target.tangent_deltas.clear();
  }
  result.triangles.clear();
  result.triangle_submesh.clear();
  std::map<std::pair<Index, Index>, Index> middle_of;
  const auto middle = [&](Index a, Index b) {
    const auto [at, is_new] = middle_of.try_emplace(std::minmax(a, b), result.vertex_count());
    if (!is_new) return at->second;
    result.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
    result.weights.append(mean_influences(mesh, {a, b}));
    for (MorphTarget& target : result.morph_targets)
      if (!target.position_deltas.empty())
        target.position_deltas.push_back(0.5f *
                                         (target.position_deltas[a] + target.position_deltas[b]));
    return at->second;
  };
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& part :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      result.triangles.push_back(part);
      result.triangle_submesh.push_back(mesh.triangle_submesh[t]);
    }
  }
  return result;
}

Mesh decimated(const Mesh& mesh, const Vec3f& corner, float cell) {
  Mesh result = empty_copy(mesh);
  std::map<std::array<int, 3>, std::vector<Index>> members;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f at = (mesh.positions[v] - corner) / cell;
    members[{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
             static_cast<int>(std::floor(at.z()))}]
        .push_back(v);
  }
  std::vector<Index> new_from_old(mesh.vertex_count());
  for (const auto& [unused, vertices] : members) {
    Vec3f sum = Vec3f::Zero();
    for (const Index vertex : vertices) {
      sum += mesh.positions[vertex];
      new_from_old[vertex] = result.vertex_count();
    }
    result.positions.push_back(sum / static_cast<float>(vertices.size()));
    result.weights.append(mean_influences(mesh, vertices));
  }
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& old = mesh.triangles[t];
    const Triangle triangle = {new_from_old[old[0]], new_from_old[old[1]], new_from_old[old[2]]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
      continue;
    result.triangles.push_back(triangle);
    result.triangle_submesh.push_back(mesh.triangle_submesh[t]);
  }
  return result;
}

}  // namespace

Character subdivided(const Character& character) {
  Character result = character;
  for (Mesh& mesh : result.meshes) mesh = subdivided(mesh);
  return result;
}

Character decimated(const Character& character, std::uint32_t cells) {
  Character result = character;
  result.rest_morph_weights.clear();
  result.clips.clear();
  for (Mesh& mesh : result.meshes) {
    Eigen::AlignedBox3f box;
    for (const Vec3f& position : mesh.positions) box.extend(Eigen::Vector3f(position));
    if (box.isEmpty()) continue;
    mesh = decimated(mesh, Vec3f(box.min()),
                     std::max(box.sizes().maxCoeff(), 1e-30f) / static_cast<float>(cells));
  }
  return result;
}

Character offset_shell(const Character& character, double share) {
  const validation::BindSurface surface = validation::make_bind_surface(character);
  Character result = character;
  for (Index m = 0; m < result.meshes.size(); ++m)
    for (Index v = 0; v < result.meshes[m].vertex_count(); ++v)
      result.meshes[m].positions[v] +=
          (share * surface.diagonal * surface.normals[surface.first_vertex[m] + v]).cast<float>();
  return result;
}

Character scaled(const Character& character, float factor) {
  Character result = character;
  for (Bone& bone : result.skeleton.bones) bone.rest.translation *= factor;
  for (Skin& skin : result.skins)
    for (Affine3f& bone_from_bind : skin.bone_from_bind) bone_from_bind.translation() *= factor;
  for (Mesh& mesh : result.meshes) {
    for (Vec3f& position : mesh.positions) position *= factor;
    for (MorphTarget& target : mesh.morph_targets)
      for (Vec3f& delta : target.position_deltas) delta *= factor;
  }
  return result;
}

double weight_of(const Character& character, Index mesh, Index vertex, const std::string& bone) {
  const Mesh& of = character.meshes[mesh];
  double sum = 0;
  for (const Influence& influence : of.weights.of(vertex))
    if (character.skeleton.bones[character.skins[of.skin].bones[influence.slot]].name == bone)
      sum += static_cast<double>(influence.weight);
  return sum;
}

double weight_distance(const Character& a, Index mesh_a, Index vertex_a, const Character& b,
                       Index mesh_b, Index vertex_b) {
  std::map<std::string, double> difference;
  const auto add = [&](const Character& character, Index mesh, Index vertex, double sign) {
    const Mesh& of = character.meshes[mesh];
    for (const Influence& influence : of.weights.of(vertex))
      difference[character.skeleton.bones[character.skins[of.skin].bones[influence.slot]].name] +=
          sign * static_cast<double>(influence.weight);
  };
  add(a, mesh_a, vertex_a, 1);
  add(b, mesh_b, vertex_b, -1);
  double sum = 0;
  for (const auto& [unused, value] : difference) sum += std::abs(value);
  return sum;
}

}  // namespace sunder::test
