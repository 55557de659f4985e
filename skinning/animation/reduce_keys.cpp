#include "skinning/animation/reduce_keys.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/internal/elementary.h"
#include "skinning/internal/rotation.h"
#include "skinning/internal/sample_channel.h"

namespace sunder::animation {
namespace {

/// The longest run of keys that is tested at once, so that the cost stays in proportion.
constexpr std::size_t kLongestRun = 256;

/// A channel of the two keys between which others are left out.
class Span {
 public:
  explicit Span(const Channel& channel) : channel_(channel) {
    span_.target = channel.target == ChannelTarget::rotation ? ChannelTarget::rotation
                                                             : ChannelTarget::morph_weights;
    span_.width = channel.width;
    span_.interpolation = channel.interpolation;
    span_.times.resize(2);
    span_.values.resize(2 * std::size_t{channel.width});
    numbers_.resize(channel.width);
  }

  /// Whether all keys in between are reproduced.
  [[nodiscard]] bool holds(std::size_t first, std::size_t last, const ReduceOptions& options) {
    const std::size_t width = channel_.width;
    span_.times = {channel_.times[first], channel_.times[last]};
    std::copy_n(channel_.values.data() + first * width, width, span_.values.data());
    std::copy_n(channel_.values.data() + last * width, width, span_.values.data() + width);
    for (std::size_t key = first + 1; key < last; ++key)
      if (!(error_at(key) <= tolerance(options))) return false;
    return true;
  }

 private:
  [[nodiscard]] double tolerance(const ReduceOptions& options) const {
    switch (channel_.target) {
      case ChannelTarget::translation: return options.metres;
      case ChannelTarget::rotation: return options.radians;
      default: return options.factor;
    }
  }

  [[nodiscard]] double error_at(std::size_t key) {
    const double time = static_cast<double>(channel_.times[key]);
    const float* const wanted = channel_.values.data() + key * channel_.width;
    if (channel_.target == ChannelTarget::rotation) {
      BoneTransform sampled;
      skinning::sample_channel(span_, time, sampled);
      const Vec4d a = normalized(Vec4d(Vec4f(wanted).cast<double>()));
      const Vec4d b = sampled.rotation.coeffs().cast<double>();
      const double chord = std::min(norm(Vec4d(a - b)), norm(Vec4d(a + b)));
      return 4.0 * elementary::asin(std::min(0.5 * chord, 1.0));
    }
    skinning::sample_channel(span_, time, numbers_);
    double largest = 0, sum = 0;
    for (std::size_t i = 0; i < channel_.width; ++i) {
      const double error =
          std::abs(static_cast<double>(numbers_[i]) - static_cast<double>(wanted[i]));
      largest = std::max(largest, error);
      sum += error * error;
    }
    return channel_.target == ChannelTarget::translation ? std::sqrt(sum) : largest;
  }

  const Channel& channel_;
  Channel span_;
  std::vector<float> numbers_;
};

}  // namespace

void reduce_keys(Channel& channel, const ReduceOptions& options) {
  if (channel.interpolation == Interpolation::cubic_spline || channel.times.size() < 3) return;
  Span span(channel);
  std::vector<std::size_t> kept = {0};
  const std::size_t last = channel.times.size() - 1;
  while (kept.back() < last) {
    const std::size_t first = kept.back();
    std::size_t next = first + 1;
    while (next < last && next - first < kLongestRun && span.holds(first, next + 1, options))
      ++next;
    kept.push_back(next);
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    channel.times[i] = channel.times[kept[i]];
    std::copy_n(channel.values.data() + kept[i] * channel.width, channel.width,
                channel.values.data() + i * channel.width);
  }
  channel.times.resize(kept.size());
  channel.values.resize(kept.size() * channel.width);
}

}  // namespace sunder::animation
