#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <vector>

#include "tools/validation_page/page_input.h"

namespace sunder::tools {

/// Rate at which clips are sampled, and the largest number of samples of one clip, beyond which the
/// rate is lower.
inline constexpr double kPageSamplesPerSecond = 30.0;
inline constexpr std::size_t kPageMostSamples = 900;

/// The data of the page: "SNDP", version, a JSON object, and the arrays that it refers to, all
/// little-endian. page/src/decode.js reads it; docs/validation_page.md describes it.
///
/// @return size_mismatch, index_out_of_range or non_finite_value if an array does not fit its
/// model; limit_exceeded beyond 65,536 slots or 255 influences per vertex. Morph targets are
/// applied as at rest.
[[nodiscard]] Result<std::vector<std::byte>> page_data(const PageInput& input);

}  // namespace sunder::tools
