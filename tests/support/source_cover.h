#pragma once

#include <sunder/tear/torn_model.h>

#include <optional>
#include <string>
#include <vector>

namespace sunder::test {

/// How the triangles of one torn mesh cover those that they are parts of: the source's, and after
/// them those of walls and caps.
struct Cover {
  std::vector<double>
      part;  ///< Per triangle: the fraction covered by its parts, retired ones left out.
  std::vector<bool> has_retired;    ///< Per triangle: whether one of its parts is retired.
  std::vector<std::string> faults;  ///< Vertices from outside, parts without area or turned over.
};

Cover cover_of(const TornModel& model, std::uint32_t mesh);

/// The area that operations removed from the surface, measured in `pose`: posed area of the source
/// minus that of its remaining parts.
/// Parts are measured where they lie on the posed source triangle, so interpolation does not enter.
/// Walls and caps are left out.
double removed_area(const TornModel& model, const ModelPose& pose);

}  // namespace sunder::test
