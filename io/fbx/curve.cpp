#include "io/fbx/curve.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace sunder::fbx {
namespace {

// Bits of KeyAttrFlags.
constexpr std::uint32_t kStep = 0x2, kCubic = 0x8;
constexpr std::uint32_t kStepAtOnce = 0x100;  ///< Of a step: the next key's value holds at once.
constexpr std::uint32_t kAutomatic = 0x100;  ///< Of a cubic: the slope follows from the neighbours.
constexpr std::uint32_t kFlatAtEqual = 0x1000, kTimeIndependent = 0x2000, kNoOvershoot = 0x4000;
constexpr std::uint32_t kRightWeighted = 0x1000000, kNextLeftWeighted = 0x2000000;
constexpr double kWeightUnit = 1e-4;
constexpr double kShortestStepTicks = 1e-4 * kTicksPerSecond;

/// Two weights share the bits of one float. Text files print it as a float or as an integer.
std::uint32_t bits_of(double stored) {
  if (stored >= 1.0 && stored < 4294967296.0) return static_cast<std::uint32_t>(stored);
  return std::bit_cast<std::uint32_t>(static_cast<float>(stored));
}

/// The parameter at which a Bézier curve from 0 to 1 with two inner values in [0, 1] is `x`.
double parameter_at(double x, double first, double second) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double u = 0.5 * (low + high), v = 1.0 - u;
    const double here = 3.0 * v * v * u * first + 3.0 * v * u * u * second + u * u * u;
    (here < x ? low : high) = u;
  }
  return 0.5 * (low + high);
}

double without_overshoot(double slope, double left_slope, double right_slope) {
  if (left_slope * right_slope <= 0.0) return 0.0;  // A key that is higher or lower than both.
  const double most = 3.0 * std::min(std::abs(left_slope), std::abs(right_slope));
  return std::clamp(slope, -most, most);
}

}  // namespace

Curve::Curve(const Record& record) {
  const std::span<const double> times = record.array("KeyTime");
  std::span<const double> values = record.array("KeyValueFloat");
  for (std::size_t i = 0; i < std::min(times.size(), values.size()); ++i)
    keys_.push_back({.ticks = times[i], .value = values[i]});
  read_attributes(record);
  solve_automatic_slopes();
  double last = -HUGE_VAL;
  std::erase_if(keys_, [&](const Key& key) {
    if (!std::isfinite(key.value) || !(key.ticks > last)) return true;
    last = key.ticks;
    return false;
  });
}

void Curve::read_attributes(const Record& record) {
  // One attribute holds for as many keys as its count says.
  const std::span<const double> flags = record.array("KeyAttrFlags");
  const std::span<const double> data = record.array("KeyAttrDataFloat");
  const std::span<const double> counts = record.array("KeyAttrRefCount");
  std::size_t key = 0;
  for (std::size_t i = 0; i < std::min(flags.size(), counts.size()); ++i) {
    for (double left = counts[i]; left > 0.5 && key < keys_.size(); --left, ++key) {
      Key& one = keys_[key];
      one.flags = static_cast<std::uint32_t>(std::clamp(flags[i], 0.0, 4294967295.0));
      if ((one.flags & kStep) != 0)
        one.span = (one.flags & kStepAtOnce) != 0 ? Span::step_at_once : Span::step;
      if ((one.flags & kCubic) == 0 || data.size() < 4 * (i + 1)) continue;
      one.span = Span::cubic;
      one.right_slope = std::isfinite(data[4 * i]) ? data[4 * i] : 0.0;
      one.next_left_slope = std::isfinite(data[4 * i + 1]) ? data[4 * i + 1] : 0.0;
      const std::uint32_t weights = bits_of(data[4 * i + 2]);
      if ((one.flags & kRightWeighted) != 0)
        one.right_weight = std::clamp((weights & 0xffffu) * kWeightUnit, 0.0, 1.0);
      if ((one.flags & kNextLeftWeighted) != 0)
        one.next_left_weight = std::clamp((weights >> 16) * kWeightUnit, 0.0, 1.0);
    }
  }
}

void Curve::solve_automatic_slopes() {
  const auto is_automatic = [](const Key& key) {
    return key.span == Span::cubic && (key.flags & kAutomatic) != 0;
  };
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (!is_automatic(keys_[i])) continue;
    const double slope = automatic_slope(i);
    keys_[i].right_slope = slope;
    if (i > 0 && keys_[i - 1].span == Span::cubic) keys_[i - 1].next_left_slope = slope;
  }
}

double Curve::automatic_slope(std::size_t key) const {
  const auto slope_to_next = [&](std::size_t i) {
    const double seconds = (keys_[i + 1].ticks - keys_[i].ticks) / kTicksPerSecond;
    return seconds > 0.0 ? (keys_[i + 1].value - keys_[i].value) / seconds : 0.0;
  };
  const std::uint32_t flags = keys_[key].flags;
  if (key == 0 || key + 1 == keys_.size()) {
    if (keys_.size() < 2 || (flags & (kFlatAtEqual | kNoOvershoot)) != 0) return 0.0;
    return slope_to_next(key == 0 ? 0 : key - 1);
  }
  const double left = slope_to_next(key - 1), right = slope_to_next(key);
  if ((flags & kFlatAtEqual) != 0 && (left == 0.0 || right == 0.0)) return 0.0;
  const double left_ticks = keys_[key].ticks - keys_[key - 1].ticks;
  const double right_ticks = keys_[key + 1].ticks - keys_[key].ticks;
  // Of the chord between the neighbours; otherwise the mean of both sides.
  const double slope = (flags & kTimeIndependent) != 0
                           ? (left * left_ticks + right * right_ticks) / (left_ticks + right_ticks)
                           : 0.5 * (left + right);
  return (flags & kNoOvershoot) != 0 ? without_overshoot(slope, left, right) : slope;
}

double Curve::at(double ticks) const {
  if (ticks <= keys_.front().ticks) return keys_.front().value;
  if (ticks >= keys_.back().ticks) return keys_.back().value;
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), ticks,
                                     [](double t, const Key& key) { return t < key.ticks; });
  const Key &a = *(next - 1), &b = *next;
  const double length = b.ticks - a.ticks, x = (ticks - a.ticks) / length;
  switch (a.span) {
    case Span::step: return a.value;
    case Span::step_at_once: return x > 0.0 ? b.value : a.value;
    case Span::line: return a.value + x * (b.value - a.value);
    case Span::cubic: break;
  }
  const double seconds = length / kTicksPerSecond;
  const double u = parameter_at(x, a.right_weight, 1.0 - a.next_left_weight), v = 1.0 - u;
  const double first = a.value + a.right_slope * seconds * a.right_weight;
  const double second = b.value - a.next_left_slope * seconds * a.next_left_weight;
  return v * v * v * a.value + 3.0 * v * v * u * first + 3.0 * v * u * u * second +
         u * u * u * b.value;
}

bool Curve::stays_at(double value) const {
  return std::all_of(keys_.begin(), keys_.end(),
                     [&](const Key& key) { return std::abs(key.value - value) <= 1e-6; });
}

void Curve::append_times(std::vector<double>& ticks) const {
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    ticks.push_back(keys_[i].ticks);
    if (i + 1 == keys_.size()) break;
    const double length = keys_[i + 1].ticks - keys_[i].ticks;
    if (length < 2.0 * kShortestStepTicks) continue;
    if (keys_[i].span == Span::step) ticks.push_back(keys_[i + 1].ticks - kShortestStepTicks);
    if (keys_[i].span == Span::step_at_once) ticks.push_back(keys_[i].ticks + kShortestStepTicks);
  }
}

}  // namespace sunder::fbx
