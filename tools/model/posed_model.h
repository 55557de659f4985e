#pragma once

#include <sunder/skinning/deform.h>

#include <vector>

namespace sunder::tools {

/// All meshes of a character in a pose, model space. O(vertices).
/// @return the failures of compute_palette() and deform_mesh().
[[nodiscard]] Result<std::vector<DeformedMesh>> deform_model(const Character& character,
                                                             const ModelPose& pose);

/// Their positions alone, in double until they are stored: less work than deform_model(), which
/// prepares meshes for many poses. O(vertices).
/// @return the failures of compute_palette().
[[nodiscard]] Result<std::vector<DeformedMesh>> pose_positions(const Character& character,
                                                               const ModelPose& pose);

/// As deform_model(), for drawing: with mend_normals().
[[nodiscard]] Result<std::vector<DeformedMesh>> pose_model(const Character& character,
                                                           const ModelPose& pose);

/// Gives meshes without normals, or with many that contradict their winding, smooth ones.
void mend_normals(const Character& character, std::vector<DeformedMesh>& posed);

struct Bounds {
  Vec3d least = Vec3d::Constant(1e300);
  Vec3d greatest = Vec3d::Constant(-1e300);

  [[nodiscard]] Vec3d centre() const { return (least + greatest) / 2; }
  [[nodiscard]] Vec3d size() const { return greatest - least; }
  [[nodiscard]] bool is_empty() const { return least.x() > greatest.x(); }
  [[nodiscard]] bool contains(const Vec3d& point) const {
    return (point.array() >= least.array()).all() && (point.array() <= greatest.array()).all();
  }
};

/// The bounds of all vertices that triangles use.
Bounds bounds_of(const Character& character, const std::vector<DeformedMesh>& posed);

}  // namespace sunder::tools
