#pragma once

#include <sunder/core/character.h>

#include "tools/page_parts/data_arrays.h"

namespace sunder::tools {

/// The skeleton at rest: ten floats per bone (translation, rotation, scale), and the morph weights.
[[nodiscard]] Json skeleton_section(const Character& character, DataArrays& arrays);

/// The keys of all clips as they are; pose.js interpolates them as sample_clip() does.
[[nodiscard]] Json clips_section(const Character& character, DataArrays& arrays);

}  // namespace sunder::tools
