#pragma once

#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The fraction of a triangle's area that lies between three places in it, given by barycentric
/// coordinates.
inline double covered_part(const std::array<double, 3>& p, const std::array<double, 3>& q,
                           const std::array<double, 3>& r) {
  return (q[1] - p[1]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[1] - p[1]);
}

/// Normal of a triangle in bind space.
inline Place normal(const SurfaceEditor& editor, Index mesh, const Triangle& of) {
  return normal(place_of(editor.births.position(mesh, of[0])),
                place_of(editor.births.position(mesh, of[1])),
                place_of(editor.births.position(mesh, of[2])));
}

/// A face that is about to be split: the places of its corners in its origin, and its winding.
class FaceSplit {
 public:
  /// A corner of the face or of a part of it.
  struct Corner {
    Index vertex = kNone;
    std::array<double, 3> barycentric = {0, 0, 0};  ///< Coordinates in the origin.
    Place at;
  };

  FaceSplit(const SurfaceEditor& editor, Index face)
      : ref_(editor.surface().triangle(face)), vertices_(editor.connectivity.vertices_of(face)) {
    const Triangle& origin = editor.fillings.origin_triangle(ref_.mesh, ref_.source_triangle);
    is_whole_ = is_same(origin, vertices_);
    const Place a = place_of(editor.births.position(ref_.mesh, vertices_[0])),
                b = place_of(editor.births.position(ref_.mesh, vertices_[1])),
                c = place_of(editor.births.position(ref_.mesh, vertices_[2]));
    normal_ = normal(a, b, c);
    corners_[0].at = a;
    corners_[1].at = b;
    corners_[2].at = c;
    for (std::size_t k = 0; k < 3; ++k) {
      corners_[k].vertex = vertices_[k];
      corners_[k].barycentric =
          is_whole_ ? kAtCorner[k] : editor.births.place_in_origin(ref_, vertices_[k]);
    }
    normal_of_origin_ = is_whole_ ? normal_ : normal(editor, ref_.mesh, origin);
    normal_squared_ = dot(normal_, normal_);
    has_origin_area_ = dot(normal_of_origin_, normal_of_origin_) > 0;
  }

  [[nodiscard]] Index mesh() const { return ref_.mesh; }
  [[nodiscard]] const Triangle& vertices() const { return vertices_; }
  [[nodiscard]] const Corner& corner(Index k) const { return corners_[k]; }

  [[nodiscard]] Birth birth_at(const std::array<double, 3>& barycentric) const {
    Birth birth{ref_.source_triangle, {0, 0, 0}};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (barycentric[k] <= 0.0) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        birth.barycentric[i] += barycentric[k] * corners_[k].barycentric[i];
        sum += barycentric[k] * corners_[k].barycentric[i];
      }
    }
    if (sum != 1)
      for (double& coordinate : birth.barycentric) coordinate /= sum;
    return birth;
  }

  /// As birth_at() on the side between two corners (0, 1, 2).
  [[nodiscard]] Birth birth_between(Index from, Index to, double fraction) const {
    const double rest = 1 - fraction;
    const auto part = [&](std::size_t k) {
      return rest * kAtCorner[from][k] + fraction * kAtCorner[to][k];
    };
    const std::array<double, 3> barycentric = {part(0), part(1), part(2)};
    return is_whole_ ? Birth{ref_.source_triangle, barycentric} : birth_at(barycentric);
  }

  /// Whether a part of the face has the winding of the face. @param after  the normal of the part.
  [[nodiscard]] bool keeps_winding(const Corner& a, const Corner& b, const Corner& c,
                                   const Place& after) const {
    if (!(covered_part(a.barycentric, b.barycentric, c.barycentric) > kLeastOriginAreas))
      return false;
    // A face without area has no winding to lose; its parts must only keep their corners apart.
    if (normal_squared_ == 0.0) {
      const auto is_apart = [](const Place& p, const Place& q) {
        return p.x != q.x || p.y != q.y || p.z != q.z;
      };
      return is_apart(a.at, b.at) && is_apart(a.at, c.at);
    }
    if (!(dot(after, normal_) > kLeastFaceAreas * normal_squared_)) return false;
    // Rounding of stored positions turns the normals of slivers: parts of parts must not end up
    // facing away.
    return !has_origin_area_ || dot(after, normal_of_origin_) > 0;
  }
  /// The same for the face with one of its corners (0, 1, 2) replaced.
  [[nodiscard]] bool keeps_winding(Index replaced, const Corner& by) const {
    const Corner &b = corners_[(replaced + 1) % 3], &c = corners_[(replaced + 2) % 3];
    return keeps_winding(by, b, c, normal(by.at, b.at, c.at));
  }

 private:
  static constexpr std::array<std::array<double, 3>, 3> kAtCorner = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  TriangleRef ref_;
  Triangle vertices_;
  std::array<Corner, 3> corners_;
  Place normal_, normal_of_origin_;
  double normal_squared_ = 0;
  bool is_whole_ = false, has_origin_area_ = false;
};

}  // namespace sunder::tear
