#pragma once

#include <sunder/tear/torn_model.h>

#include <optional>
#include <string>
#include <vector>

namespace sunder::test {

/// How the triangles of one torn mesh cover their origins: the triangles of the source, followed by
/// those of walls and caps.
struct Cover {
  std::vector<double>
      part;  ///< Per origin: the fraction covered by its parts, without retired ones.
  std::vector<bool> has_retired;  ///< Per origin: whether one of its parts is retired.
  /// Vertices of other triangles, parts without area, inverted parts.
  std::vector<std::string> faults;
};

Cover cover_of(const TornModel& model, std::uint32_t mesh);

/// The area that operations removed from the surface, measured in `pose`: posed area of the source
/// minus that of its remaining parts. Parts are measured on the posed source triangle, so that
/// interpolation errors do not matter. Walls and caps do not count.
double removed_area(const TornModel& model, const ModelPose& pose);

}  // namespace sunder::test
