#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/deform.h>

#include <vector>

namespace sunder::tools {

/// Carries what is posed in one mesh back into bind space, as linear blend skinning of its vertices
/// in one pose has it.
class BindSpace {
 public:
  /// The linear parts by which skinning moves the positions and the normals of a vertex.
  struct Blended {
    Mat3d of_positions = Mat3d::Zero(), of_normals = Mat3d::Zero();
  };

  /// @param character  must outlive it; vertices may be appended.
  /// @return the failures of compute_palette().
  [[nodiscard]] static Result<BindSpace> create(const Character& character, std::uint32_t mesh,
                                                const ModelPose& pose);

  [[nodiscard]] Blended at(std::uint32_t vertex) const;
  /// Zero where the bones of the vertex flatten space.
  [[nodiscard]] Vec3f displacement(std::uint32_t vertex, const Vec3f& posed) const;
  /// Of unit length; the posed one where they do.
  [[nodiscard]] Vec3f normal(std::uint32_t vertex, const Vec3f& posed) const;

 private:
  const SkinWeights* weights_ = nullptr;
  std::vector<Affine3d> palette_;
  std::vector<Mat3d> normal_matrices_;
};

/// The morph target that takes a posed mesh from `from` to `to`: displacements in model space,
/// carried back into bind space through the skinning of each vertex, so that linear blend skinning
/// in this pose gives `to` up to rounding. Normals and tangents likewise, as far as the mesh has
/// them. Vertices that are equal in both get zeros, as do those whose bones flatten space there.
/// @param from  as the pose alone puts the vertices; with the arrays of `to`.
/// @return without arrays if nothing is displaced; the failures of compute_palette().
[[nodiscard]] Result<MorphTarget> displacement_in_bind(const Character& character,
                                                       std::uint32_t mesh, const ModelPose& pose,
                                                       const DeformedMesh& from,
                                                       const DeformedMesh& to);

}  // namespace sunder::tools
