#pragma once

#include <sunder/core/skeleton.h>

#include "tear/detached/piece_meshes.h"

namespace sunder::tear {

/// A posed mesh, relative to PiecePose::origin.
struct PosedPieceMesh {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec4f> tangents;
};

/// The vertices of a piece in a pose, as an engine skins them. The origin is one of them, so that
/// a piece far from the model's origin loses no precision.
struct PiecePose {
  Vec3d origin = Vec3d::Zero();  ///< Model space.
  std::vector<PosedPieceMesh> meshes;
};

/// @param pose  of the model. @return the failures of skinning. @throws std::bad_alloc
[[nodiscard]] Result<PiecePose> pose_piece(const PieceMeshes& piece, const ModelPose& pose,
                                           const SurfaceEditor& editor);

/// @return the failures of compute_mass().
[[nodiscard]] Result<MassProperties> mass_of(const PieceMeshes& piece, const PiecePose& posed,
                                             const MassOptions& options);

}  // namespace sunder::tear
