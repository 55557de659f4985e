#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <span>
#include <vector>

namespace sunder::bodies {

/// The edges of a surface that miss a neighbour of the opposite direction.
struct OpenEdges {
  /// (from, to), vertices; per group of edges that hang together. Each vertex stands for all at its
  /// position. Around each position as many edges of a group arrive as leave.
  std::vector<std::vector<std::array<std::uint32_t, 2>>> groups;
};

/// @param triangles  with indices of `positions`; retired ones are skipped. O(T log T). @throws
/// std::bad_alloc
[[nodiscard]] OpenEdges find_open_edges(std::span<const Vec3d> positions,
                                        std::span<const Triangle> triangles);

}  // namespace sunder::bodies
