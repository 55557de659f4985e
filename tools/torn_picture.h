#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>

#include <filesystem>
#include <memory>
#include <span>

namespace sunder::tools {

/// Draws what operations left of a model, in the pose of the last one and from where that came: 480
/// x 360 pixels, lips pulled apart, the pieces of a cut moved apart, the surface light and what is
/// inside red.
///
/// @param history  at least one operation; all can be applied to the source.
[[nodiscard]] Status draw_torn(std::shared_ptr<const Character> source,
                               std::span<const Operation> history,
                               const std::filesystem::path& png);

}  // namespace sunder::tools
