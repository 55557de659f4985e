#pragma once

#include <sunder/plan/plan.h>

#include <vector>

namespace sunder::plan {

/// Where the blade shall be along the curve and above it at a time: it comes down at the begin of
/// the curve, follows it, and rises at its end.
class Timeline {
 public:
  explicit Timeline(const PlanTiming& timing) : timing_(timing) {}

  [[nodiscard]] double cut_begins() const { return timing_.approach; }
  [[nodiscard]] double cut_ends() const { return timing_.approach + timing_.cut; }
  [[nodiscard]] double end() const { return cut_ends() + timing_.retreat; }

  /// Share of the curve's length. Starts and stops with a continuous acceleration.
  [[nodiscard]] double share_at(double time) const;
  /// Shares of the curve per second between the begin and the end of the cut, where it is even.
  [[nodiscard]] double even_speed() const;
  /// 0 during the cut, 1 at begin and end of the motion.
  [[nodiscard]] double lift_at(double time) const;

  /// Times from 0 to the end between which a motion may be a polynomial: 48 even steps in the cut;
  /// in approach and retreat even steps of about the same length or, of more than 56, so many that
  /// grow evenly with the distance from the cut.
  [[nodiscard]] std::vector<double> knots() const;

 private:
  PlanTiming timing_;
};

}  // namespace sunder::plan
