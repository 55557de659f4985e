#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <vector>

namespace sunder {

/// Shape of a character's surface, all meshes together. Counts refer to surface points: vertices
/// with equal position, weights, morph displacements and tear side are one point, so UV seams, hard
/// edges and material borders are not borders. Retired triangles, and points without other
/// triangles, are not counted.
struct TopologyCounts {
  std::uint32_t vertices = 0;  ///< All entries of the arrays, used or not.
  /// Points that have triangles. TornModel::point_count() also counts points that lost theirs.
  std::uint32_t points = 0;
  std::uint32_t triangles = 0;
  std::uint32_t edges = 0;
  std::uint32_t boundary_edges = 0;  ///< With one face.
  /// With more than two faces, or with two that disagree in winding.
  std::uint32_t non_manifold_edges = 0;
  std::uint32_t boundary_loops = 0;
  std::uint32_t components = 0;  ///< Sets of triangles connected across edges.
  /// With a repeated point, or without area in bind space.
  std::uint32_t degenerate_triangles = 0;
};

/// Counts from the arrays alone. O(vertices + triangles), allocates. Reentrant.
/// @param points_of_mesh  if given, it becomes the number of points of each mesh, counted as if the
///        character had no other mesh.
/// @return limit_exceeded: out of memory.
[[nodiscard]] SUNDER_API Result<TopologyCounts> count_topology(
    const Character& character, std::vector<std::uint32_t>* points_of_mesh = nullptr);

}  // namespace sunder
