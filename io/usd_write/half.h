#pragma once

namespace sunder::usd {

/// The nearest number that the 16 bits of a half can be, as USD stores scales. Beyond its range:
/// the largest.
[[nodiscard]] float nearest_half(float value);

}  // namespace sunder::usd
