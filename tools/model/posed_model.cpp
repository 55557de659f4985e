#include "tools/model/posed_model.h"

#include <sunder/skinning/deform.h>

#include "skinning/internal/reference.h"

namespace sunder::tools {
namespace {

void make_normals(const Mesh& mesh, DeformedMesh& posed) {
  posed.normals.assign(posed.positions.size(), Vec3f::Zero());
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3f& a = posed.positions[triangle[0]];
    const Vec3f doubled_area =
        (posed.positions[triangle[1]] - a).cross(posed.positions[triangle[2]] - a);
    for (const std::uint32_t vertex : triangle) posed.normals[vertex] += doubled_area;
  }
  for (Vec3f& normal : posed.normals)
    normal = normal.norm() > 0.0f ? normal.normalized() : Vec3f::UnitY();
}

/// Whether more than a twentieth of the triangles have normals that contradict their winding.
bool has_wrong_normals(const Mesh& mesh, const DeformedMesh& posed) {
  std::size_t wrong = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3f& a = posed.positions[triangle[0]];
    const Vec3f by_winding =
        (posed.positions[triangle[1]] - a).cross(posed.positions[triangle[2]] - a);
    const Vec3f by_normals =
        posed.normals[triangle[0]] + posed.normals[triangle[1]] + posed.normals[triangle[2]];
    if (by_winding.dot(by_normals) < 0.0f) ++wrong;
  }
  return 20 * wrong > mesh.triangles.size();
}

}  // namespace

Result<std::vector<DeformedMesh>> deform_model(const Character& character, const ModelPose& pose) {
  std::vector<DeformedMesh> posed(character.meshes.size());
  std::vector<Affine3f> palette;
  for (std::size_t i = 0; i < posed.size(); ++i) {
    const Mesh& mesh = character.meshes[i];
    const Skin& skin = character.skins[mesh.skin];
    palette.resize(skin.bones.size());
    if (const Status status = compute_palette(skin, pose, palette); !status) return status;
    if (const Status status = deform_mesh(mesh, palette, pose.morph_weights, posed[i]); !status)
      return status;
  }
  return posed;
}

Result<std::vector<DeformedMesh>> pose_positions(const Character& character,
                                                 const ModelPose& pose) {
  std::vector<DeformedMesh> posed(character.meshes.size());
  std::vector<Affine3d> palette;
  for (std::size_t i = 0; i < posed.size(); ++i) {
    const Mesh& mesh = character.meshes[i];
    const Skin& skin = character.skins[mesh.skin];
    palette.resize(skin.bones.size());
    if (const Status status = compute_palette(skin, pose, palette); !status) return status;
    posed[i].positions.reserve(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      posed[i].positions.emplace_back(
          deform_position_reference(mesh, v, palette, pose.morph_weights).cast<float>());
  }
  return posed;
}

Result<std::vector<DeformedMesh>> pose_model(const Character& character, const ModelPose& pose) {
  Result<std::vector<DeformedMesh>> posed = deform_model(character, pose);
  if (posed) mend_normals(character, *posed);
  return posed;
}

void mend_normals(const Character& character, std::vector<DeformedMesh>& posed) {
  for (std::size_t i = 0; i < posed.size(); ++i)
    if (posed[i].normals.empty() || has_wrong_normals(character.meshes[i], posed[i]))
      make_normals(character.meshes[i], posed[i]);
}

Bounds bounds_of(const Character& character, const std::vector<DeformedMesh>& posed) {
  Bounds bounds;
  for (std::size_t i = 0; i < posed.size(); ++i)
    for (const Triangle& triangle : character.meshes[i].triangles)
      for (const std::uint32_t vertex : triangle) {
        const Vec3d position = posed[i].positions[vertex].cast<double>();
        bounds.least = bounds.least.cwiseMin(position);
        bounds.greatest = bounds.greatest.cwiseMax(position);
      }
  return bounds;
}

}  // namespace sunder::tools
