#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include "tools/validation_page/data_arrays.h"

namespace sunder::tools {

/// The skeleton at rest, ten floats per bone: translation, rotation, scale.
[[nodiscard]] Json skeleton_section(const Skeleton& skeleton, DataArrays& arrays);

/// Samples of all clips at equal distances in time, for the parts of bones that leave rest.
[[nodiscard]] Result<Json> clips_section(const Character& character, DataArrays& arrays);

}  // namespace sunder::tools
