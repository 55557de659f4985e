#pragma once

#include "core/internal/ordered.h"
#include "tear/filling/filling.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/rim.h"

namespace sunder::tear {

/// A vertex of a wall, and its surface point.
struct WallCorner {
  Index point = kNone;
  Index vertex = kNone;
};

inline Vec3d unit_or(const Vec3d& vector, const Vec3d& otherwise) {
  const double length = norm(vector);
  return length > kShortestDirection ? Vec3d(vector / length) : otherwise;
}

/// Builds walls, one border at a time.
class WallBuilder {
 public:
  WallBuilder(const Workpiece& work, Index material)
      : work_(work), filling_(Fillings::kWall, work, material) {}

  /// Runs `build`, which adds triangles for some borders, and connects them. @return false if that
  /// fails; then nothing is added.
  template <class Build>
  bool add(std::span<const Index> half_edges, Build build) {
    const EditLog::Mark before = work_.editor.mark();
    is_sound_ = true;
    build();
    if (is_sound_ && filling_.connect(half_edges, before)) return true;
    filling_.take_back(before);
    return false;
  }

  [[nodiscard]] const Workpiece& work() const { return work_; }
  [[nodiscard]] Filling& filling() { return filling_; }
  [[nodiscard]] ScratchMemory& scratch() const { return work_.editor.scratch(); }
  [[nodiscard]] const Surface& surface() const { return work_.editor.surface(); }
  [[nodiscard]] Vec3d position(Index point) const {
    return work_.posed.position(work_.editor, point);
  }
  [[nodiscard]] Index mesh_of(Index half_edge) const {
    return surface().triangle(half_edge / 3).mesh;
  }

  /// Rims of different skins cannot share vertices; all points of one rim have the same skin.
  [[nodiscard]] bool have_one_skin(const Rim& a, const Rim& b) const {
    const auto& meshes = work_.editor.character().meshes;
    return meshes[mesh_of(a.half_edges.front())].skin == meshes[mesh_of(b.half_edges.front())].skin;
  }

  /// Adds a vertex like that of a corner, at the same point.
  [[nodiscard]] WallCorner add_top(Index mesh, Index corner) {
    return {surface().corner_point[corner], filling_.add_rim_vertex(mesh, corner)};
  }
  /// Adds a vertex like another one of the same point.
  [[nodiscard]] WallCorner add_copy(Index mesh, Index point, const VertexRef& like) {
    return {point, work_.editor.births.append_rim_vertex(mesh, like)};
  }
  /// Adds a vertex at a posed displacement from another one.
  [[nodiscard]] WallCorner add_bottom(Index mesh, const WallCorner& top, Index point,
                                      const Vec3d& down) {
    const Index vertex = work_.editor.births.append_filling_vertex(mesh, top.vertex);
    Mesh& of = work_.editor.mutable_mesh(mesh);
    const Vec3d bind = filling_.to_bind(mesh, vertex, down);
    of.positions[vertex] = (of.positions[vertex].cast<double>() + bind).cast<float>();
    return {point, vertex};
  }
  [[nodiscard]] Index add_point(const Vec3d& at) {
    const Index point = append_filling_point(work_.editor);
    work_.posed.pin(point, at);
    return point;
  }
  void shade(Index mesh, const WallCorner& corner, const Vec3d& normal, const Vec3d& tangent,
             const Vec2d& uv) {
    filling_.shade(mesh, corner.vertex, normal, tangent, uv);
  }
  void add_triangle(Index mesh, Index like_corner, const WallCorner& a, const WallCorner& b,
                    const WallCorner& c) {
    const auto place = [&](const WallCorner& of) -> Eigen::Vector3d {
      return work_.editor.births.position(mesh, of.vertex).cast<double>();
    };
    const Eigen::Vector3d ab = place(b) - place(a), ac = place(c) - place(a);
    is_sound_ &= squared_norm(ab.cross(ac)) > 0;  // else stored positions are too coarse for it
    filling_.add_triangle(mesh, like_corner, {a.point, b.point, c.point},
                          {a.vertex, b.vertex, c.vertex});
  }
  void fail() { is_sound_ = false; }

 private:
  Workpiece work_;
  Filling filling_;
  bool is_sound_ = true;
};

}  // namespace sunder::tear
