#pragma once

#include <sunder/core/api.h>
#include <sunder/core/skin.h>

#include <cstdint>
#include <span>

namespace sunder {

/// A vertex' weights as integers that sum to exactly 255 or 65535, by the largest remainder: each is rounded down, and the units
/// that are left go to the largest remainders; of equal ones, to the larger weight, then to the first. So each is less than one
/// unit from its weight over the sum of all, and a larger weight never gets fewer units than a smaller one. Weights below a unit
/// may become 0; where there are more influences than units, some do.
///
/// @param quantised  one an influence, written.
/// @return false, with nothing written, for spans of different lengths and for what are no weights: none at all, negative ones,
///         ones that are not finite, or only zeros.
/// O(n^2) at worst, n being a few; no allocation. The weights need not sum to one.
[[nodiscard]] SUNDER_API bool quantise_weights(std::span<const Influence> influences, std::span<std::uint8_t> quantised);
[[nodiscard]] SUNDER_API bool quantise_weights(std::span<const Influence> influences, std::span<std::uint16_t> quantised);

}  // namespace sunder
