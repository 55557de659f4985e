#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bench/weights/refit_rigs.h"

namespace sunder::bench {

/// The gain of one way to fit on one rig, torn four times in poses of some clips and fitted over
/// these clips alone: the root mean square error of barycentric weights divided by that of the
/// fits.
struct MethodGain {
  double fitted = 1;                      ///< Over the poses of the fit.
  double held_out = 1;                    ///< Over the clips that were not fitted.
  double least_clip = 1;                  ///< The least over one of these.
  std::size_t clips = 0, clips_lost = 0;  ///< Clips that were not fitted; those with a loss.
  double seconds = 0;
};

/// The methods, in the order of MethodGains::methods.
[[nodiscard]] const std::vector<std::string>& method_names();

struct MethodGains {
  std::string rig;
  std::size_t points = 0;
  std::vector<MethodGain> methods;  ///< Empty: the rig has no second clip, or nothing bends.
};

/// @param seed  of the tears, and of the half of the clips that is fitted.
[[nodiscard]] MethodGains compare_methods(const BendingRig& rig, std::uint64_t seed);

}  // namespace sunder::bench
