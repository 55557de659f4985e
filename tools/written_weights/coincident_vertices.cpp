#include "tools/written_weights/coincident_vertices.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace sunder::tools {
namespace {

/// Equal for vertices that move alike in every pose.
struct Place {
  std::array<double, 3> position = {};  // in the bind pose, model space
  std::vector<std::pair<std::uint32_t, float>> weight_of_bone;

  auto operator<=>(const Place&) const = default;
};

Place place_of(const Character& character, const ModelPose& bind, const Mesh& mesh,
               std::uint32_t vertex) {
  const Skin& skin = character.skins[mesh.skin];
  std::vector<std::pair<std::uint32_t, Influence>> of_bones;
  for (const Influence& influence : mesh.weights.of(vertex))
    of_bones.emplace_back(skin.bones[influence.slot], influence);
  std::ranges::sort(of_bones, {},
                    [](const auto& of) { return std::pair(of.first, of.second.weight); });
  Place place;
  Vec3d sum = Vec3d::Zero();
  const Vec3d in_mesh = mesh.positions[vertex].cast<double>();
  for (const auto& [bone, influence] : of_bones) {
    sum +=
        static_cast<double>(influence.weight) *
        (bind.model_from_bone[bone] * skin.bone_from_bind[influence.slot].cast<double>() * in_mesh);
    place.weight_of_bone.emplace_back(bone, influence.weight);
  }
  place.position = {sum.x(), sum.y(), sum.z()};
  return place;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t mesh) {
  while (parents[mesh] != mesh) mesh = parents[mesh] = parents[parents[mesh]];
  return mesh;
}

}  // namespace

CoincidentVertices::CoincidentVertices(const Character& character, const ModelPose& bind,
                                       const std::vector<bool>& takes_part)
    : first_(character.meshes.size()) {
  const auto mesh_count = static_cast<std::uint32_t>(character.meshes.size());
  std::vector<std::uint32_t> parents(mesh_count);
  std::iota(parents.begin(), parents.end(), 0u);
  std::map<Place, MeshVertex> first_at;
  for (std::uint32_t m = 0; m < mesh_count; ++m) {
    const Mesh& mesh = character.meshes[m];
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      first_[m].push_back({m, v});
      if (!takes_part[m]) continue;
      first_[m][v] =
          first_at.try_emplace(place_of(character, bind, mesh, v), MeshVertex{m, v}).first->second;
      const std::uint32_t a = root_of(parents, m), b = root_of(parents, first_[m][v].mesh);
      parents[std::max(a, b)] = std::min(a, b);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> of_root;
  for (std::uint32_t m = 0; m < mesh_count; ++m)
    if (takes_part[m]) of_root[root_of(parents, m)].push_back(m);
  for (auto& [root, meshes] : of_root) joined_.push_back(std::move(meshes));
}

}  // namespace sunder::tools
