#pragma once

#include <sunder/core/character.h>

#include <span>
#include <vector>

namespace sunder::validation {

/// The points of a surface: vertices that a UV seam, a hard edge or a material border duplicates
/// are one point. Vertices of all meshes are numbered one after the other.
struct Weld {
  std::vector<Index> point_of_vertex;
  Index point_count = 0;
};

/// Joins the vertices that have the same place, skin and tear side. Weights do not matter, so the
/// vertices of a crack without a tear side are joined too.
/// @param positions  per vertex of all meshes, model space; compared after rounding to float.
/// @return points numbered by their first vertex. O(vertices), allocates.
[[nodiscard]] Weld weld_vertices(const Character& character, std::span<const Vec3d> positions);

/// The value of `_TEARSIDE` per vertex of a mesh; empty if the mesh does not have it.
[[nodiscard]] std::span<const float> tear_sides(const Mesh& mesh);

}  // namespace sunder::validation
