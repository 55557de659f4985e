#pragma once

#include <string>
#include <vector>

namespace sunder::bench {

/// How the surface looks along tears of width 0, in poses of the clips that were not fitted.
struct LipQuality {
  std::string name;  ///< How the points were weighted.
  double gain = 0;   ///< Root mean square error of barycentric weights / that of these.
  /// Root mean square of the angle between the faces on both sides of a lip, less the angle between
  /// the same faces of exact points; degrees.
  double normal_jump = 0;
  double crack = 0;  ///< Largest distance between points that were one, share of the diagonal.
  double microseconds = 0;  ///< Of the whole refit, per point.
};

/// Barycentric weights, refits point by point, and refits of neighbours together by their
/// smoothness: medians over rigged files, where they can be read, and random rigs.
[[nodiscard]] std::vector<LipQuality> measure_lip_quality();

}  // namespace sunder::bench
