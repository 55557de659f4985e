#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <vector>

#include "pipeline/validation/match/weld.h"

namespace sunder::validation {

/// All meshes of a character as one surface in model space, in one pose, mostly that in which they
/// were bound.
/// Vertices and triangles of all meshes are numbered one after the other.
struct BindSurface {
  std::vector<Index> first_vertex = {0};    ///< Per mesh, and the end.
  std::vector<Index> first_triangle = {0};  ///< Per mesh, and the end.

  std::vector<Vec3d> positions;  ///< Per vertex, metres.
  /// Per vertex: mean of the faces around its point, weighted by their angles; computed from the
  /// positions, stored normals are not read. Where faces cancel out (two sheets back to back) it is
  /// the mean over the faces of the vertex alone. Zero without faces.
  std::vector<Vec3d> normals;
  std::vector<float> tear_side;           ///< Per vertex; 0 where the mesh has no tear.
  std::vector<Index> triangle_of_vertex;  ///< The smallest one with an area; kNone: there is none.
  Weld weld;

  std::vector<Triangle> triangles;
  std::vector<bool> has_area;         ///< Per triangle; false also for retired ones.
  std::vector<std::uint64_t> region;  ///< Per triangle: a hash of the names of mesh and submesh.
  double diagonal = 0;                ///< Of the box around all vertices, metres.

  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] Index mesh_of_vertex(Index vertex) const;
  [[nodiscard]] Index mesh_of_triangle(Index triangle) const;
};

/// In the character's own bind pose, or in another one.
/// @param character  indices in range and finite; weights need not be normalised.
/// @param pose  one matrix per bone.
/// O(vertices + triangles), allocates.
[[nodiscard]] BindSurface make_bind_surface(const Character& character);
[[nodiscard]] BindSurface make_bind_surface(const Character& character, const ModelPose& pose);

/// model_from_bind at bind, per skin and slot: bind_pose() times bone_from_bind. The identity but
/// for rounding where all skins bind a bone alike.
[[nodiscard]] std::vector<std::vector<Affine3d>> bind_palettes(const Character& character,
                                                               const ModelPose& bind);

}  // namespace sunder::validation
