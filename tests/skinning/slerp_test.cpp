// Rotations between two keys against spherical interpolation in long double.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "skinning/internal/sample_channel.h"
#include "support/machine/random.h"

namespace sunder::test {
namespace {

struct Quaternion {
  long double of[4];
};

Quaternion normalized(const float* values) {
  long double square = 0;
  for (int i = 0; i < 4; ++i) square += static_cast<long double>(values[i]) * values[i];
  Quaternion unit;
  for (int i = 0; i < 4; ++i) unit.of[i] = values[i] / std::sqrt(square);
  return unit;
}

/// Along the shorter arc.
Quaternion slerp(const Quaternion& a, const Quaternion& b, long double fraction) {
  long double apart = 0, together = 0, cosine = 0;
  for (int i = 0; i < 4; ++i) {
    cosine += a.of[i] * b.of[i];
    apart += (a.of[i] - b.of[i]) * (a.of[i] - b.of[i]);
    together += (a.of[i] + b.of[i]) * (a.of[i] + b.of[i]);
  }
  const long double sign = cosine < 0 ? -1 : 1;
  const long double angle =
      2 * std::atan2(std::sqrt(std::min(apart, together)), std::sqrt(std::max(apart, together)));
  Quaternion between;
  for (int i = 0; i < 4; ++i)
    between.of[i] = angle < 1e-12L ? a.of[i]
                                   : (std::sin((1 - fraction) * angle) * a.of[i] +
                                      sign * std::sin(fraction * angle) * b.of[i]) /
                                         std::sin(angle);
  return between;
}

TEST(Slerp, is_that_of_long_double_to_the_digits_of_float) {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    Channel channel;
    channel.target = ChannelTarget::rotation;
    channel.width = 4;
    channel.times = {0, 1};
    // The second key is the first, turned a little or much, or its negative.
    const double turned = std::exp2(-random.uniform(0, 24)) * 2;
    const double sign = i % 2 == 0 ? 1 : -1;
    std::vector<double> first;
    for (int k = 0; k < 4; ++k) first.push_back(random.uniform(-1, 1));
    for (const double number : first) channel.values.push_back(static_cast<float>(number));
    for (const double number : first)
      channel.values.push_back(
          static_cast<float>(sign * (number + turned * random.uniform(-1, 1))));
    const double time = random.uniform(0, 1);

    std::uint32_t cursor = 0;
    BoneTransform bone;
    skinning::sample_channel(channel, time, cursor, bone);
    const Quaternion wanted =
        slerp(normalized(channel.values.data()), normalized(channel.values.data() + 4),
              static_cast<long double>(static_cast<float>(time)));
    for (int k = 0; k < 4; ++k)
      ASSERT_NEAR(static_cast<double>(bone.rotation.coeffs()[k]), static_cast<double>(wanted.of[k]),
                  4e-7)
          << i;
  }
}

}  // namespace
}  // namespace sunder::test
