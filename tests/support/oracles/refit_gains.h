#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sunder::test {

/// The gain of a refit over one group of poses that were not fitted: the root mean square error of
/// barycentric weights divided by that of the refit. Errors below the rounding of stored positions
/// count as that.
struct GroupGain {
  enum class Kind { clip, rest, operation, range_of_motion, random };
  Kind kind = Kind::clip;
  double gain = 1;
  double gain_of_percentile95 = 1, gain_of_maximum = 1;  ///< The same of other statistics.
  double barycentric = 0;  ///< Root mean square error, share of the diagonal.
};

/// The gains of one model, torn four times.
struct RefitGains {
  std::string name;
  std::uint64_t seed = 0;
  std::size_t points = 0, refitted = 0;
  double microseconds = 0;  ///< Of the whole refit, poses and moments included, per point.
  std::vector<GroupGain> groups;

  [[nodiscard]] double least() const;
  /// The number of groups over which the fits are worse than barycentric weights.
  [[nodiscard]] std::size_t lost() const;
  /// The median over the groups of a kind that have an error; 0 without any.
  [[nodiscard]] double median(GroupGain::Kind kind,
                              double GroupGain::*gain = &GroupGain::gain) const;
};

/// Tears a model four times in poses of its clips, with K = 4, and fits over clips and range of
/// motion, as `sunder tear --weights refit` does. Points of one bone alone do not count.
/// @return no groups if four strokes tear nothing that bends.
[[nodiscard]] RefitGains measure_refit_gains(std::string name,
                                             const std::shared_ptr<const Character>& character,
                                             std::uint64_t seed);

}  // namespace sunder::test
