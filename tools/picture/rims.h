#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::tools {

/// An edge that operations opened. Its face lies left of a -> b, seen from outside.
struct RimEdge {
  std::uint32_t mesh = 0;
  std::uint32_t a = 0, b = 0;  ///< Vertices.
};

/// Border edges that the source did not have. Edges of walls and caps are not rims.
/// O(size of the model).
[[nodiscard]] std::vector<RimEdge> find_rims(const TornModel& model);

}  // namespace sunder::tools
