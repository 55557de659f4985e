#include "tools/tear/torn_place.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <array>

#include "skinning/internal/reference.h"

namespace sunder::tools {
namespace {

constexpr std::uint32_t kMostNearTriangles = 300;

/// The sums from which a place is made.
struct Sums {
  Vec3d centre = Vec3d::Zero(), normal = Vec3d::Zero();
  std::vector<double> weight_of_bone;
  std::uint32_t triangles = 0;
};

void add_triangle(const Mesh& mesh, const Skin& skin, const Triangle& triangle,
                  const std::vector<Affine3d>& palette, const ModelPose& pose, Sums& sums) {
  std::array<Vec3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = deform_position_reference(mesh, triangle[i], palette, pose.morph_weights);
    sums.centre += corners[i] / 3;
    for (const Influence& influence : mesh.weights.of(triangle[i]))
      sums.weight_of_bone[skin.bones[influence.slot]] += static_cast<double>(influence.weight);
  }
  sums.normal += (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  ++sums.triangles;
}

}  // namespace

TriangleCounts triangle_counts(const Character& character) {
  TriangleCounts counts;
  for (const Mesh& mesh : character.meshes) counts.push_back(mesh.triangle_count());
  return counts;
}

std::optional<TornPlace> torn_place(const TornModel& model, const TriangleCounts& before,
                                    const ModelPose& pose) {
  const Character& character = model.character();
  Sums sums;
  sums.weight_of_bone.resize(character.skeleton.bones.size());
  std::vector<Affine3d> palette;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    if (mesh.triangle_count() <= before[m]) continue;
    const Skin& skin = character.skins[mesh.skin];
    palette.resize(skin.bones.size());
    if (!compute_palette(skin, pose, palette)) return {};
    const std::uint32_t of_source = model.source().meshes[m].triangle_count();
    const std::uint32_t step = 1 + (mesh.triangle_count() - before[m]) / kMostNearTriangles;
    for (std::uint32_t t = before[m]; t < mesh.triangle_count(); t += step)
      if (!is_retired(mesh.triangles[t]) && model.source_triangle(m, t) < of_source)
        add_triangle(mesh, skin, mesh.triangles[t], palette, pose, sums);
  }
  if (sums.triangles == 0) return {};
  const auto strongest = std::ranges::max_element(sums.weight_of_bone);
  return TornPlace{
      sums.centre / sums.triangles, sums.normal,
      character.skeleton.bones[static_cast<std::size_t>(strongest - sums.weight_of_bone.begin())]
          .name};
}

}  // namespace sunder::tools
