#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "core/internal/ordered.h"
#include "tear/filling/wall_ends.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// Transforms posed directions and displacements to bind space.
class BindFromPosed {
 public:
  /// @param posed_from_bind  the linear part of blended matrices.
  explicit BindFromPosed(const Mat3d& posed_from_bind);
  /// @return `fallback` if the matrices are nearly singular.
  [[nodiscard]] Vec3d apply(const Vec3d& posed, const Vec3d& fallback) const {
    return is_regular_ ? Vec3d(multiply(inverse_, posed)) : fallback;
  }

 private:
  bool is_regular_;
  Mat3d inverse_;
};

/// Adds triangles that close an opening. Their vertices take position and weights from the rim and
/// have their own normals, tangents and texture coordinates. Temporary data lie in the scratch
/// memory of the operation.
class Filling {
 public:
  /// @param name  of the submesh that each mesh gets for the filling.
  /// @param material  of these submeshes; kNone: what `_WALL_MATERIAL` says at the vertices of the
  ///                  rim, or that of the rim.
  Filling(const char* name, const Workpiece& work, Index material = kNone);

  /// Adds a vertex at a corner of the rim, for a filling in `mesh`. The mesh of the rim may be
  /// another one with the same skin.
  [[nodiscard]] Index add_rim_vertex(Index mesh, Index corner);
  /// The attributes of a vertex that is not on the rim.
  struct Inner {
    Vec3d bind_position = Vec3d::Zero();
    std::span<const Influence> influences;       ///< Normalised.
    std::span<const Vec3d> morph_displacements;  ///< One per morph target.
  };
  [[nodiscard]] Index add_inner_vertex(Index mesh, Index like, const Inner& inner);
  /// Sets the posed normal, the posed direction of u, and the texture coordinates of a vertex.
  void shade(Index mesh, Index vertex, const Vec3d& normal, const Vec3d& tangent, const Vec2d& uv);
  /// The same for a vertex that has the position and weights of another one, but faces in the
  /// opposite direction.
  void shade_from_behind(Index mesh, Index vertex, Index other, const Vec2d& uv);
  /// Transforms a posed displacement at a vertex to bind space; returns it as it is if the linear
  /// part of the blended bone matrices is nearly singular.
  [[nodiscard]] Vec3d to_bind(Index mesh, Index vertex, const Vec3d& posed) {
    return bind_from_posed(mesh, vertex).apply(posed, posed);
  }

  /// @param like_corner  a corner of the rim, which chooses the material.
  void add_triangle(Index mesh, Index like_corner, const std::array<Index, 3>& points,
                    const Triangle& vertices);
  /// Connects the triangles added since a mark to each other and to the half-edges of the rim,
  /// whose points are older than the mark; no other points of the triangles are.
  /// @return false if an edge would have too many faces, for example because points of the rim are
  /// already joined by another edge.
  [[nodiscard]] bool connect(std::span<const Index> rim_half_edges, const EditLog::Mark& before);
  /// Removes everything added since the mark.
  void take_back(const EditLog::Mark& before);

  /// The submeshes so far, to go on with them in a later call of the same operation.
  [[nodiscard]] std::span<const FillingSubmesh> submeshes() const { return submeshes_; }
  void use(std::span<const FillingSubmesh> submeshes) {
    submeshes_.assign(submeshes.begin(), submeshes.end());
  }

 private:
  /// The matrix that moves the normals of a bone.
  struct NormalMatrix {
    Mat3d linear;
    bool is_known = false;
  };

  /// The inverses of the blended matrices of a vertex, of which the next vertex is likely to have
  /// the same.
  struct Blend {
    Index skin = kNone;
    ScratchVector<Influence> influences;
    std::optional<BindFromPosed> of_places, of_normals;  ///< Computed when they are needed.
  };

  /// Of the triangles at a corner of the rim.
  struct Material {
    Index index = kNone;
    /// By the vertices, so that the filling of one mesh may have several.
    bool is_authored = false;
  };

  [[nodiscard]] Material material_at(Index rim_corner) const;
  [[nodiscard]] const Mat3d& normal_matrix(Index skin, Index slot);
  [[nodiscard]] Blend& blend_of(Index mesh, Index vertex);
  [[nodiscard]] const BindFromPosed& bind_from_posed(Index mesh, Index vertex);
  [[nodiscard]] const BindFromPosed& bind_from_posed_normals(Index mesh, Index vertex);

  const char* name_;
  Index material_;
  Workpiece work_;
  ScratchVector<FillingSubmesh> submeshes_;
  ScratchVector<NormalMatrix> normal_matrices_;  ///< By slot of the skin used last.
  Index skin_ = kNone;
  Blend blend_;  ///< Of the vertex used last.
};

}  // namespace sunder::tear
