#pragma once

#include <sunder/scene/character_instance.h>

#include <memory>
#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

constexpr double kPictureStep = 1.0 / 60;  ///< Seconds per step of the tissue in pictures.

/// A character of soft tissue under an even tension, so that the lips of its tears open.
[[nodiscard]] Result<CharacterInstance> make_gaping_instance(
    std::shared_ptr<const Character> character);

/// Steps the tissue in one pose until nothing moves, or for three seconds.
[[nodiscard]] Status open_lips(CharacterInstance& instance, const ModelPose& pose);

/// Moves posed vertices by the displacements of the last advance().
void displace(CharacterInstance& instance, std::vector<DeformedMesh>& posed);

}  // namespace sunder::tools
