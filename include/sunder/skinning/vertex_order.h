#pragma once

#include <sunder/core/api.h>
#include <sunder/core/mesh.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder {

/// An order of vertices in which neighbours are moved by the same bones, so that SkinnedMesh reads least and writes straight on; of
/// equal bones, the order that there was. For asset pipelines, where vertices may still be renumbered.
/// @return old_from_new. O(V log V).
[[nodiscard]] SUNDER_API std::vector<std::uint32_t> order_for_skinning(const Mesh& mesh);

/// Renumbers the vertices of a mesh: every attribute, the weights, morph targets, and the corners of triangles.
/// @param old_from_new  each vertex once.
/// @return size_mismatch or index_out_of_range (nothing is changed). O(size of the mesh).
[[nodiscard]] SUNDER_API Status reorder_vertices(Mesh& mesh, std::span<const std::uint32_t> old_from_new);

}  // namespace sunder
