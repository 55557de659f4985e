#pragma once

#include <sunder/core/status.h>
#include <sunder/skinning/vertex_arrays.h>

namespace sunder::skinning {

/// @return size_mismatch, or index_out_of_range with the range of `moved`. If `moved` is empty,
/// nothing else is checked. O(moved ranges).
[[nodiscard]] Status check_displacements(const VertexDisplacements& displacements,
                                         std::uint32_t vertex_count);

/// Displaces vertices [first, end), whose posed positions are already in `target`.
/// @param target  its strides are not 0.
void displace_vertices(const VertexDisplacements& displacements, const VertexTarget& target,
                       std::uint32_t first, std::uint32_t end);

}  // namespace sunder::skinning
