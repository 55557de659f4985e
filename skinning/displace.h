#pragma once

#include <sunder/core/status.h>
#include <sunder/skinning/vertex_arrays.h>

#include "skinning/blocks.h"

namespace sunder::skinning {

/// @return size_mismatch, or index_out_of_range with the range of `moved`. If `moved` is empty,
/// nothing else is checked. O(moved ranges).
[[nodiscard]] Status check_displacements(const VertexDisplacements& displacements,
                                         std::uint32_t vertex_count);

/// Displaced vertices whose normals and tangents are turned together.
///
/// The displaced surface around a vertex is mapped by I + K R^T: K = sum_k U_k s_k^T of the stored
/// gradients s_k, R is the mean of the particles' matrices.
struct DisplacedLanes {
  alignas(64) float mean_first[4 * kLanes] = {};   ///< R, column by column: 0 to 3 of each lane.
  alignas(64) float mean_second[4 * kLanes] = {};  ///< 4 to 7.
  alignas(64) float mean_last[kLanes] = {};
  alignas(64) float stretch[3][4 * kLanes] = {};  ///< The columns of K: x y z 0 of each lane.
  alignas(64) float normals[3 * kLanes] = {};     ///< x of all lanes, y, z.
  alignas(64) float tangents[3 * kLanes] = {};
  std::uint32_t vertices[kLanes] = {};
  std::uint32_t count = 0;
};

/// Displaces vertices [first, end), whose posed positions are already in `target`, with the best
/// vectors of the CPU. Their normals and tangents are turned as soon as `lanes` is full.
/// @param target  its strides are not 0.
void displace_vertices(const VertexDisplacements& displacements, const VertexTarget& target,
                       std::uint32_t first, std::uint32_t end, DisplacedLanes& lanes);

/// Turns the normals and tangents of the vertices that are still in `lanes`, and empties it.
void turn_displaced(const VertexTarget& target, DisplacedLanes& lanes);

}  // namespace sunder::skinning
