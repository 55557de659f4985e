#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::tools {

/// An edge that operations opened. Its face lies at the left of a -> b, seen from outside.
struct RimEdge {
  std::uint32_t mesh = 0;
  std::uint32_t a = 0, b = 0;  ///< Vertices.
};

/// Where the surface ends and the source's did not. Edges of walls and caps are no rims. O(size of
/// the model).
[[nodiscard]] std::vector<RimEdge> find_rims(const TornModel& model);

}  // namespace sunder::tools
