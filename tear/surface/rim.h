#pragma once

#include <vector>

#include "tear/internal/surface.h"

namespace sunder::tear {

/// A chain of border half-edges.
struct Rim {
  std::vector<Index> half_edges;
  bool is_closed = false;
};

/// Chains border half-edges into rims, in the order of their first half-edges. Each half-edge is
/// followed by the given one that leaves the point where it ends; there is at most one, because a
/// point has one fan.
[[nodiscard]] std::vector<Rim> chain_rims(const std::vector<Index>& half_edges,
                                          const Surface& surface);

}  // namespace sunder::tear
