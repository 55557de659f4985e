#include "tools/model/bone_extents.h"

#include <algorithm>
#include <span>

namespace sunder::tools {
namespace {

/// Calls `visit(bone, position)` for each vertex of the model.
template <class Visit>
void for_each_vertex(const Character& character, const std::vector<DeformedMesh>& posed,
                     const Visit& visit) {
  for (std::size_t m = 0; m < posed.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    const std::vector<std::uint32_t> bones = predominant_bones(character.skins[mesh.skin], mesh);
    for (std::size_t v = 0; v < bones.size(); ++v)
      if (bones[v] != kNone) visit(bones[v], Vec3d(posed[m].positions[v].cast<double>()));
  }
}

/// Bones whose child joints are closer than this share of the model's diagonal do not lead there.
constexpr double kSamePlace = 1e-5;

void find_children(const Skeleton& skeleton, double same_place, std::vector<BoneExtent>& extents) {
  for (std::uint32_t bone = 0; bone < extents.size(); ++bone) {
    const std::uint32_t parent = skeleton.bones[bone].parent;
    if (parent == kNone || extents[bone].vertices_of_branch == 0) continue;
    const double distance = (extents[bone].joint - extents[parent].joint).norm();
    if (distance <= same_place) continue;
    std::uint32_t& chosen = extents[parent].leads_to;
    if (chosen != kNone && extents[chosen].vertices_of_branch >= extents[bone].vertices_of_branch)
      continue;
    chosen = bone;
    extents[parent].length = distance;
  }
}

}  // namespace

std::vector<std::uint32_t> predominant_bones(const Skin& skin, const Mesh& mesh) {
  std::vector<std::uint32_t> bones(mesh.vertex_count(), kNone);
  for (const Triangle& triangle : mesh.triangles) {
    if (is_retired(triangle)) continue;
    for (const std::uint32_t vertex : triangle) {
      const std::span<const Influence> influences = mesh.weights.of(vertex);
      const auto greatest = std::max_element(
          influences.begin(), influences.end(),
          [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
      bones[vertex] = skin.bones[greatest->slot];
    }
  }
  return bones;
}

std::vector<BoneExtent> measure_bones(const Character& character, const ModelPose& pose,
                                      const std::vector<DeformedMesh>& posed) {
  const Skeleton& skeleton = character.skeleton;
  std::vector<BoneExtent> extents(skeleton.bones.size());
  for (std::size_t bone = 0; bone < extents.size(); ++bone)
    extents[bone].joint = pose.model_from_bone[bone].translation();
  for_each_vertex(character, posed, [&](std::uint32_t bone, const Vec3d& position) {
    BoneExtent& extent = extents[bone];
    ++extent.vertices;
    extent.bounds.least = extent.bounds.least.cwiseMin(position);
    extent.bounds.greatest = extent.bounds.greatest.cwiseMax(position);
  });
  for (std::size_t bone = extents.size(); bone-- > 0;) {  // Children come after their parents.
    extents[bone].vertices_of_branch += extents[bone].vertices;
    if (const std::uint32_t parent = skeleton.bones[bone].parent; parent != kNone)
      extents[parent].vertices_of_branch += extents[bone].vertices_of_branch;
  }
  find_children(skeleton, kSamePlace * bounds_of(character, posed).size().norm(), extents);
  for_each_vertex(character, posed, [&](std::uint32_t bone, const Vec3d& position) {
    BoneExtent& extent = extents[bone];
    if (extent.leads_to == kNone)
      extent.length = std::max(extent.length, (position - extent.joint).norm());
  });
  return extents;
}

}  // namespace sunder::tools
