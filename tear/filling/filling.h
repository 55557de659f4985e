#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Adds triangles that close an opening. Their vertices take position and weights from the rim and
/// have their own normals, tangents and texture coordinates.
class Filling {
 public:
  /// @param name  of the submesh that each mesh gets for the filling.
  Filling(std::string name, const Workpiece& work) : name_(std::move(name)), work_(work) {}

  /// Adds a vertex at a corner of the rim, for a filling in `mesh`. The mesh of the rim may be
  /// another one with the same skin.
  [[nodiscard]] Index add_rim_vertex(Index mesh, Index corner);
  /// The attributes of a vertex that is not on the rim.
  struct Inner {
    Vec3d bind_position = Vec3d::Zero();
    std::vector<Influence> influences;       ///< Normalised.
    std::vector<Vec3d> morph_displacements;  ///< One per morph target.
  };
  [[nodiscard]] Index add_inner_vertex(Index mesh, Index like, const Inner& inner);
  /// Sets the posed normal, the posed direction of u, and the texture coordinates of a vertex.
  void shade(Index mesh, Index vertex, const Vec3d& normal, const Vec3d& tangent, const Vec2d& uv);
  /// Linear part of the blended bone matrices of a vertex.
  [[nodiscard]] Mat3d blended(Index mesh, Index vertex) const;

  /// @param like_corner  a corner of the rim; the filling uses the material of its submesh.
  void add_triangle(Index mesh, Index like_corner, const std::array<Index, 3>& points,
                    const Triangle& vertices);
  /// Connects the added triangles to each other and to the half-edges of the rim.
  /// @return false if an edge would have too many faces, for example because points of the rim are
  /// already joined by another edge.
  [[nodiscard]] bool connect(const std::vector<Index>& rim_half_edges);
  /// Removes everything added since the mark.
  void take_back(const EditLog::Mark& before);

 private:
  std::string name_;
  Workpiece work_;
  std::map<Index, Index> submesh_of_mesh_;
  std::vector<Index> triangles_;  ///< Added since the last connect().
};

/// Transforms a posed direction or displacement to bind space by the linear part of the blended
/// matrices; returns `fallback` if that is nearly singular.
[[nodiscard]] Vec3d to_bind(const Mat3d& posed_from_bind, const Vec3d& posed,
                            const Vec3d& fallback);

}  // namespace sunder::tear
