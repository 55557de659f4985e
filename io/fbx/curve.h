#pragma once

#include <cstdint>
#include <vector>

#include "io/fbx/record.h"

namespace sunder::fbx {

/// FBX counts time in this many ticks per second.
constexpr double kTicksPerSecond = 46186158000.0;

/// A number that changes over time: keys, and between two of them a step, a line or a cubic.
class Curve {
 public:
  /// Reads a record AnimationCurve. Keys that are not later than the one before are left out.
  explicit Curve(const Record& record);

  [[nodiscard]] bool is_empty() const { return keys_.empty(); }
  /// Before the first and after the last key the value is that of this key.
  [[nodiscard]] double at(double ticks) const;
  /// Whether all keys have this value, within a millionth.
  [[nodiscard]] bool stays_at(double value) const;
  /// Appends the times of the keys, and of the last moment before each step.
  void append_times(std::vector<double>& ticks) const;

 private:
  enum class Span : std::uint8_t { step, step_at_once, line, cubic };
  struct Key {
    double ticks = 0.0, value = 0.0;
    std::uint32_t flags = 0;
    Span span = Span::line;                           ///< From this key to the next one.
    double right_slope = 0.0, next_left_slope = 0.0;  ///< Per second.
    double right_weight = 1.0 / 3.0, next_left_weight = 1.0 / 3.0;
  };

  void read_attributes(const Record& record);
  void solve_automatic_slopes();
  [[nodiscard]] double automatic_slope(std::size_t key) const;

  std::vector<Key> keys_;
};

}  // namespace sunder::fbx
