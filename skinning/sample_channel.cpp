#include "skinning/internal/sample_channel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/internal/ordered.h"

namespace sunder::skinning {
namespace {

/// The position of a time among the keys of a channel.
struct KeySpan {
  std::size_t key = 0;  ///< The key at or before the time.
  float fraction = 0;   ///< Fraction of the way to the next key, in [0, 1]; 0 if the value is held.
  float seconds = 0;    ///< Between the two keys.
};

/// Whether a key is the last one at or before a time between the first and the last key.
bool is_before(std::span<const float> times, std::size_t key, double time) {
  return key < times.size() - 1 && static_cast<double>(times[key]) <= time &&
         time < static_cast<double>(times[key + 1]);
}

std::size_t search_key(std::span<const float> times, double time) {
  const auto after = std::upper_bound(
      times.begin(), times.end(), time,
      [](double value, float key_time) { return value < static_cast<double>(key_time); });
  return static_cast<std::size_t>(after - times.begin()) - 1;
}

/// @param cursor  a guess of the key, which saves the search; updated.
KeySpan find_keys(std::span<const float> times, double time, std::uint32_t& cursor) {
  if (time <= static_cast<double>(times.front())) return {};
  if (time >= static_cast<double>(times.back())) return {times.size() - 1, 0, 0};
  std::size_t key = cursor;
  if (!is_before(times, key, time)) {
    ++key;
    if (!is_before(times, key, time)) key = search_key(times, time);
    cursor = static_cast<std::uint32_t>(key);
  }
  const float seconds = times[key + 1] - times[key];
  return {
      key,
      static_cast<float>((time - static_cast<double>(times[key])) / static_cast<double>(seconds)),
      seconds};
}

/// Reads one float of the interpolated value. Linear rotations are interpolated by slerp instead.
float interpolate(const Channel& channel, const KeySpan& at, std::uint32_t component) {
  const std::uint32_t width = channel.width;
  if (channel.interpolation == Interpolation::cubic_spline) {
    const float* values = channel.values.data() + at.key * 3 * width + component;
    const float value = values[width];
    if (at.fraction == 0.0f) return value;
    const float out_tangent = values[2 * width];
    const float next_in_tangent = values[3 * width];
    const float next_value = values[4 * width];
    const float t = at.fraction, t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * value + at.seconds * (t3 - 2 * t2 + t) * out_tangent +
           (3 * t2 - 2 * t3) * next_value + at.seconds * (t3 - t2) * next_in_tangent;
  }
  const float* values = channel.values.data() + at.key * width + component;
  if (channel.interpolation == Interpolation::step || at.fraction == 0.0f) return values[0];
  return values[0] + at.fraction * (values[width] - values[0]);
}

Quatf normalized(const Quatf& rotation) {
  const float length = norm(rotation);
  return length > 0.0f ? Quatf(rotation.coeffs() / length) : Quatf(Quatf::Identity());
}

/// The two factors of slerp along an angle below pi / 2 with the given cosine. elementary.h has the
/// same functions with all digits of double; a factor needs those of float, and a character has
/// hundreds. Polynomials near minimax: both have an error below 3e-10.
std::pair<float, float> slerp_factors(double cosine, double fraction) {
  constexpr auto sine_of = [](double x) {
    const double z = x * x;
    const double series =
        -0x1.555555546033dp-3 +
        z * (0x1.11110fda8ff95p-7 + z * (-0x1.a01905a717122p-13 +
                                         z * (0x1.71968de079b19p-19 - z * 0x1.9db160d0baed4p-26)));
    return x + x * z * series;
  };
  // The arc sine of a number up to 1/2: of the cosine, or of the sine of half the angle.
  const bool is_wide = cosine < 0.5;
  const double z = is_wide ? cosine * cosine : 0.5 * (1 - cosine);
  const double s = is_wide ? cosine : std::sqrt(z);
  const double square = z * z;
  const double series = (0x1.5555555c02cb6p-3 + z * 0x1.33331ecbf1761p-4) +
                        square * ((0x1.6dc0f18cb8435p-5 + z * 0x1.efedbd4f435d6p-6) +
                                  square * ((0x1.82dd2081987cep-6 + z * 0x1.5a70f87bae6f3p-7) +
                                            square * 0x1.fb88165019619p-6));
  const double arc = s + s * z * series;
  const double angle = is_wide ? 0.5 * std::numbers::pi - arc : 2 * arc;
  const double per_sine = 1 / std::sqrt((1 - cosine) * (1 + cosine));
  return {static_cast<float>(sine_of((1 - fraction) * angle) * per_sine),
          static_cast<float>(sine_of(fraction * angle) * per_sine)};
}

/// Along the shorter arc. Eigen's own function adds in another order, and calls the C library.
Quatf slerp(const Quatf& from, const Quatf& to, float fraction) {
  const float cosine = dot(from.coeffs(), to.coeffs());
  float of_from = 1.0f - fraction, of_to = fraction;
  if (std::abs(cosine) < 1.0f - std::numeric_limits<float>::epsilon())
    std::tie(of_from, of_to) = slerp_factors(std::abs(cosine), fraction);
  if (cosine < 0) of_to = -of_to;
  return Quatf(of_from * from.coeffs() + of_to * to.coeffs());
}

Quatf sample_rotation(const Channel& channel, const KeySpan& at) {
  if (channel.interpolation == Interpolation::linear && at.fraction > 0.0f) {
    const float* values = channel.values.data() + at.key * 4;
    const Quatf from = normalized(Quatf(Eigen::Map<const Eigen::Vector4f>(values)));
    const Quatf to = normalized(Quatf(Eigen::Map<const Eigen::Vector4f>(values + 4)));
    return normalized(slerp(from, to, at.fraction));
  }
  Vec4f value;
  for (std::uint32_t i = 0; i < 4; ++i) value[i] = interpolate(channel, at, i);
  return normalized(Quatf(value));
}

Vec3f sample_vector(const Channel& channel, const KeySpan& at) {
  return {interpolate(channel, at, 0), interpolate(channel, at, 1), interpolate(channel, at, 2)};
}

}  // namespace

void sample_channel(const Channel& channel, double time, std::uint32_t& cursor,
                    BoneTransform& bone) {
  const KeySpan at = find_keys(channel.times, time, cursor);
  switch (channel.target) {
    case ChannelTarget::translation: bone.translation = sample_vector(channel, at); break;
    case ChannelTarget::rotation: bone.rotation = sample_rotation(channel, at); break;
    case ChannelTarget::scale: bone.scale = sample_vector(channel, at); break;
    case ChannelTarget::morph_weights: break;
  }
}

void sample_channel(const Channel& channel, double time, std::uint32_t& cursor,
                    std::span<float> morph_weights) {
  const KeySpan at = find_keys(channel.times, time, cursor);
  for (std::uint32_t k = 0; k < channel.width; ++k)
    morph_weights[channel.index + k] = interpolate(channel, at, k);
}

void sample_channel(const Channel& channel, double time, BoneTransform& bone) {
  std::uint32_t no_guess = kNone;
  sample_channel(channel, time, no_guess, bone);
}

void sample_channel(const Channel& channel, double time, std::span<float> morph_weights) {
  std::uint32_t no_guess = kNone;
  sample_channel(channel, time, no_guess, morph_weights);
}

}  // namespace sunder::skinning
