#include "io/usd_write/half.h"

#include <algorithm>
#include <cmath>

namespace sunder::usd {

float nearest_half(float value) {
  constexpr float kLargest = 65504.0f;
  constexpr int kLeastExponent = -13;  // of the smallest normal number, 0.5 x 2^-13
  constexpr int kDigits = 11;
  int exponent = 0;
  std::frexp(value, &exponent);
  const int places = kDigits - std::max(exponent, kLeastExponent);
  return std::clamp(std::ldexp(std::nearbyint(std::ldexp(value, places)), -places), -kLargest,
                    kLargest);
}

}  // namespace sunder::usd
