#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Adds triangles that close what was opened: vertices that take their place and weights from the
/// rim, with normals, tangents and texture coordinates of their own.
class Filling {
 public:
  /// @param name  of the submesh that each mesh gets for it.
  Filling(std::string name, const Workpiece& work) : name_(std::move(name)), work_(work) {}

  /// A vertex at a corner of the rim, for a filling in `mesh`. The rim's mesh may be another one
  /// with the same skin.
  [[nodiscard]] Index add_rim_vertex(Index mesh, Index corner);
  /// What a vertex that is not on the rim is made of.
  struct Inner {
    Vec3d bind_position = Vec3d::Zero();
    std::vector<Influence> influences;       ///< Normalised.
    std::vector<Vec3d> morph_displacements;  ///< Of each target.
  };
  [[nodiscard]] Index add_inner_vertex(Index mesh, Index like, const Inner& inner);
  /// How the vertex looks in the pose: its normal, the direction in which u grows, and texture
  /// coordinates.
  void shade(Index mesh, Index vertex, const Vec3d& normal, const Vec3d& tangent, const Vec2d& uv);
  /// Linear part of the vertex' blended bone matrices.
  [[nodiscard]] Mat3d blended(Index mesh, Index vertex) const;

  /// @param like_corner  of the rim: its submesh' material is the filling's.
  void add_triangle(Index mesh, Index like_corner, const std::array<Index, 3>& points,
                    const Triangle& vertices);
  /// Joins the triangles added to one another and to the rim's half-edges. @return false where an
  /// edge would have too many faces: also where points of the rim are joined elsewhere, by an edge
  /// that is not the rim's.
  [[nodiscard]] bool connect(const std::vector<Index>& rim_half_edges);
  /// Takes back what was added since.
  void take_back(const SurfaceEditor::Mark& before);

 private:
  std::string name_;
  Workpiece work_;
  std::map<Index, Index> submesh_of_mesh_;
  std::vector<Index> triangles_;  ///< Added since the last connect().
};

/// A posed direction, or displacement, taken back to bind space by the linear part of what poses
/// it; `fallback` where that is nearly singular.
[[nodiscard]] Vec3d to_bind(const Mat3d& posed_from_bind, const Vec3d& posed,
                            const Vec3d& fallback);

}  // namespace sunder::tear
