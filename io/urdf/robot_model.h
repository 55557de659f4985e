#pragma once

#include <sunder/io/character_file.h>
#include <sunder/robot/robot.h>

#include "io/urdf/link_meshes.h"

namespace sunder::urdf {

/// From the root link, z up, to model space, y up.
[[nodiscard]] Affine3d y_up_from_z_up();

/// The character of a robot: a bone per link, and the meshes on them. With a document for saving if
/// it has meshes.
[[nodiscard]] Result<LoadedCharacter> make_model(const Robot& robot, LinkMeshes meshes,
                                                 const Affine3d& model_from_root,
                                                 const LoadOptions& options);

}  // namespace sunder::urdf
