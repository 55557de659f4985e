#pragma once

#include <sunder/io/character_file.h>
#include <sunder/operation/operation.h>
#include <sunder/particles/authored_tissue.h>

#include <filesystem>
#include <span>

#include "tools/budget/budget.h"
#include "tools/messages/messages.h"
#include "tools/picture/posed_robot.h"

namespace sunder::tools {

/// Draws a torn model in the pose of its last operation, seen from the side from which that came;
/// 1280 x 960 pixels. Lips are pulled apart, the pieces of a cut are moved apart; the surface has
/// the materials of its file, wounds show flesh. Takes seconds, which a progress bar shows.
///
/// @param history   at least one operation; all are valid for the source.
/// @param messages  get a warning if textures are missing.
/// @param budget    not ended while the file is written.
/// @param robot     stands beside the model, or null. The picture then shows the wound and what of
///                 the robot is near, from the side.
/// @param authored  the fields of the tissue whose lips gape; empty: uniform.
[[nodiscard]] Status draw_torn(const LoadedCharacter& loaded, std::span<const Operation> history,
                               const std::filesystem::path& png, const Messages& messages,
                               Budget& budget, const PosedRobot* robot = nullptr,
                               const AuthoredTissue& authored = {});

}  // namespace sunder::tools
