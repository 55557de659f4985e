#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>

#include <filesystem>
#include <memory>
#include <span>

namespace sunder::tools {

/// Draws a torn model in the pose of its last operation, seen from the side from which that came;
/// 480 x 360 pixels. Lips are pulled apart, the pieces of a cut are moved apart, the surface is
/// light, its inside red.
///
/// @param history  at least one operation; all are valid for the source.
[[nodiscard]] Status draw_torn(std::shared_ptr<const Character> source,
                               std::span<const Operation> history,
                               const std::filesystem::path& png);

}  // namespace sunder::tools
