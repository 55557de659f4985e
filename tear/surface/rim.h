#pragma once

#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// Border half-edges in the order in which one follows another.
struct Rim {
  std::vector<Index> half_edges;
  bool is_closed = false;
};

/// Chains border half-edges into rims, in the order of their first ones. Each is followed, among
/// those given, by the one that leaves the point where it ends: a point has one fan, so there is
/// one at most.
[[nodiscard]] std::vector<Rim> chain_rims(const std::vector<Index>& half_edges,
                                          const Surface& surface);

}  // namespace sunder::tear
