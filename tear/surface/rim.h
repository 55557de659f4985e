#pragma once

#include <array>
#include <span>

#include "tear/internal/surface.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// A chain of border half-edges.
struct Rim {
  explicit Rim(ScratchMemory& scratch) : half_edges(&scratch) {}

  ScratchVector<Index> half_edges;
  bool is_closed = false;
};

/// Chains border half-edges into rims, in the order of their first half-edges. Each half-edge is
/// followed by the given one that leaves the point where it ends; there is at most one, because a
/// point has one fan.
[[nodiscard]] ScratchVector<Rim> chain_rims(std::span<const Index> half_edges,
                                            const Surface& surface, ScratchMemory& scratch);

/// The same where some points have several fans.
/// @param following  half-edges that end at such points, ascending, and those that follow them.
[[nodiscard]] ScratchVector<Rim> chain_rims(std::span<const Index> half_edges,
                                            std::span<const std::array<Index, 2>> following,
                                            const Surface& surface, ScratchMemory& scratch);

}  // namespace sunder::tear
