#pragma once

#include "tear/surface_editor.h"

namespace sunder::tear {

/// Smaller parts of a source triangle are not made: rounding of barycentric coordinates could turn them over.
inline constexpr double kLeastPart = 1e-14;

/// The part of a triangle that lies between three places in it, by their barycentric coordinates.
inline double covered_part(const std::array<double, 3>& p, const std::array<double, 3>& q, const std::array<double, 3>& r) {
  return (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]);
}

// Plain numbers: this is asked for each face that a tear crosses.
struct Direction {
  double x = 0, y = 0, z = 0;
};

inline double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Of a triangle in bind space; its length is twice the area.
inline Direction normal(const Mesh& mesh, const Triangle& of) {
  const auto from_first = [&](Index vertex) -> Direction {
    const Vec3f &a = mesh.positions[of[0]], &b = mesh.positions[vertex];
    return {static_cast<double>(b.x()) - static_cast<double>(a.x()), static_cast<double>(b.y()) - static_cast<double>(a.y()),
            static_cast<double>(b.z()) - static_cast<double>(a.z())};
  };
  const Direction b = from_first(of[1]), c = from_first(of[2]);
  return {b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x};
}

/// A face that is to be split: where its corners lie in its origin, and how it is turned.
class SurfaceEditor::FaceSplit {
 public:
  FaceSplit(const SurfaceEditor& editor, Index face)
      : editor_(&editor), ref_(editor.surface_.triangle(face)), vertices_(editor.vertices_of(face)) {
    const Mesh& mesh = editor.character_.meshes[ref_.mesh];
    const Triangle& origin = editor.origin_triangle(ref_.mesh, ref_.source_triangle);
    normal_ = normal(mesh, vertices_);
    if (is_same(origin, vertices_)) {
      places_ = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
      normal_of_origin_ = normal_;
    } else {
      for (std::size_t k = 0; k < 3; ++k) places_[k] = editor.place_in_origin(ref_, vertices_[k]);
      normal_of_origin_ = normal(mesh, origin);
    }
    normal_squared_ = dot(normal_, normal_);
    has_origin_area_ = dot(normal_of_origin_, normal_of_origin_) > 0;
  }

  /// A corner of the face or of a part of it.
  struct Corner {
    Index vertex = kNone;
    std::array<double, 3> place = {0, 0, 0};  ///< Barycentric coordinates in the origin.
  };

  [[nodiscard]] Index mesh() const { return ref_.mesh; }
  [[nodiscard]] const Triangle& vertices() const { return vertices_; }
  [[nodiscard]] Corner corner(Index k) const { return {vertices_[k], places_[k]}; }

  [[nodiscard]] Birth birth_at(const std::array<double, 3>& barycentric) const {
    Birth birth{ref_.source_triangle, {0, 0, 0}};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (barycentric[k] <= 0.0) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        birth.barycentric[i] += barycentric[k] * places_[k][i];
        sum += barycentric[k] * places_[k][i];
      }
    }
    if (sum != 1)
      for (double& coordinate : birth.barycentric) coordinate /= sum;
    return birth;
  }

  /// Whether a part of the face is turned as the face is.
  [[nodiscard]] bool keeps_winding(const Corner& a, const Corner& b, const Corner& c) const {
    if (!(covered_part(a.place, b.place, c.place) > kLeastPart)) return false;
    const Mesh& mesh = editor_->character_.meshes[ref_.mesh];
    // A face without area has no winding to lose; its parts must only keep their corners apart.
    if (normal_squared_ == 0.0) {
      const Vec3f &at_a = mesh.positions[a.vertex], &at_b = mesh.positions[b.vertex], &at_c = mesh.positions[c.vertex];
      return at_a != at_b && at_a != at_c;
    }
    const Direction after = normal(mesh, {a.vertex, b.vertex, c.vertex});
    if (!(dot(after, normal_) > 1e-9 * normal_squared_)) return false;
    // Normals of slivers are as crooked as stored positions are coarse: parts of parts must not end up facing away.
    return !has_origin_area_ || dot(after, normal_of_origin_) > 0;
  }
  /// The same of the face with one of its corners (0, 1, 2) replaced.
  [[nodiscard]] bool keeps_winding(Index replaced, const Corner& by) const {
    return keeps_winding(by, corner((replaced + 1) % 3), corner((replaced + 2) % 3));
  }

 private:
  const SurfaceEditor* editor_;
  TriangleRef ref_;
  Triangle vertices_;
  std::array<std::array<double, 3>, 3> places_;
  Direction normal_, normal_of_origin_;
  double normal_squared_ = 0;
  bool has_origin_area_ = false;
};

}  // namespace sunder::tear
