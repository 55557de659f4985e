#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::tools {

/// An edge that operations opened. Its face lies left of a -> b, seen from outside.
struct RimEdge {
  std::uint32_t mesh = 0;
  std::uint32_t a = 0, b = 0;  ///< Vertices.
  std::uint32_t triangle = 0;  ///< Its face.
};

/// Border edges that the source did not have. Edges of walls and caps are not rims.
/// O(size of the model).
[[nodiscard]] std::vector<RimEdge> find_rims(const TornModel& model);

/// Border edges with an end at one of some points, whether or not the source had them; but for
/// those of walls and caps. O(triangles).
/// @param is_wanted  per point; points beyond its end are not.
[[nodiscard]] std::vector<RimEdge> find_borders_at(const TornModel& model,
                                                   const std::vector<bool>& is_wanted);

}  // namespace sunder::tools
