#include "tear/entry.h"

#include <algorithm>
#include <cmath>

namespace sunder::tear {
namespace {

using Corners = std::array<Vec3d, 3>;

Corners posed_corners(const SurfaceEditor& editor, PosedPoints& posed, Index triangle) {
  const Index* points = &editor.surface().corner_point[3 * triangle];
  return {posed.position(editor, points[0]), posed.position(editor, points[1]), posed.position(editor, points[2])};
}

/// The part of a triangle that lies in the plane, as two points on its edges.
struct Crossing {
  struct End {
    std::array<double, 3> barycentric = {0, 0, 0};
    Vec2d position = Vec2d::Zero();  ///< In the plane.
  };
  std::array<End, 2> ends;
};

std::optional<Crossing> cross_triangle(const BladePlane& plane, const Corners& corners) {
  std::array<double, 3> distance;
  for (std::size_t k = 0; k < 3; ++k) distance[k] = plane.distance(corners[k]);
  Crossing crossing;
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    if ((distance[k] >= 0) == (distance[l] >= 0)) continue;
    const double t = distance[k] / (distance[k] - distance[l]);
    Crossing::End& end = crossing.ends[found++];
    end.barycentric[k] = 1 - t;
    end.barycentric[l] = t;
    end.position = plane.project(corners[k] + t * (corners[l] - corners[k]));
  }
  return found == 2 ? std::optional(crossing) : std::nullopt;
}

/// Cuts [begin, end] of the line from a to b to a half-plane; false where nothing is left.
bool clip(const BladePlane::HalfPlane& half_plane, const Vec2d& a, const Vec2d& b, double& begin, double& end) {
  const double at_a = half_plane.value(a), at_b = half_plane.value(b);
  if (at_a < 0 && at_b < 0) return false;
  if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
  if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
  return begin <= end;
}

}  // namespace

std::optional<SurfaceHit> first_hit(const Blade& blade, const SurfaceEditor& editor, PosedPoints& posed) {
  // Moeller and Trumbore 1997, edges included so that no ray slips between two faces.
  const Vec3d direction = blade.tip - blade.base;
  std::optional<SurfaceHit> nearest;
  double nearest_depth = 1.0;
  for (Index t = 0; t < editor.surface().triangle_count(); ++t) {
    if (editor.surface().has_repeated_point(t)) continue;
    const Corners corners = posed_corners(editor, posed, t);
    const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Vec3d h = direction.cross(ac);
    const double determinant = ab.dot(h);
    if (!(std::abs(determinant) > 1e-14 * ab.norm() * ac.norm() * direction.norm())) continue;
    const Vec3d from_corner = blade.base - corners[0];
    const double u = from_corner.dot(h) / determinant;
    const Vec3d q = from_corner.cross(ab);
    const double v = direction.dot(q) / determinant;
    const double depth = ac.dot(q) / determinant;
    constexpr double kEdge = 1e-12;
    if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge || depth < 0 || depth > nearest_depth) continue;
    if (nearest && depth == nearest_depth) continue;
    nearest_depth = depth;
    nearest = SurfaceHit{t, {std::max(0.0, 1 - u - v), std::max(0.0, u), std::max(0.0, v)}, blade.base + depth * direction, 0};
  }
  return nearest;
}

std::optional<SurfaceHit> first_contact(const BladePlane& plane, double progress, const SurfaceEditor& editor, PosedPoints& posed) {
  const BladePlane::HalfPlane not_before = plane.from_progress(progress);
  std::optional<SurfaceHit> nearest;
  SweepCoordinates nearest_at;
  for (Index t = 0; t < editor.surface().triangle_count(); ++t) {
    if (editor.surface().has_repeated_point(t)) continue;
    const Corners corners = posed_corners(editor, posed, t);
    const auto crossing = cross_triangle(plane, corners);
    if (!crossing) continue;
    const Vec2d &a = crossing->ends[0].position, &b = crossing->ends[1].position;
    double begin = 0, end = 1;
    bool is_reached = clip(not_before, a, b, begin, end);
    for (const auto& half_plane : plane.reach()) is_reached = is_reached && clip(half_plane, a, b, begin, end);
    if (!is_reached || end - begin < kSnap) continue;  // what is left of a triangle after its neighbour's end was snapped

    const SweepCoordinates at_begin = plane.sweep_coordinates(a + begin * (b - a));
    const SweepCoordinates at_end = plane.sweep_coordinates(a + end * (b - a));
    const bool forward = at_begin.progress <= at_end.progress;
    const SweepCoordinates& low = forward ? at_begin : at_end;
    const SweepCoordinates& high = forward ? at_end : at_begin;
    if (!(high.progress > std::max(low.progress, progress) + kSamePlace)) continue;
    const bool is_nearer = !nearest || low.progress < nearest_at.progress - kSamePlace ||
                           (low.progress < nearest_at.progress + kSamePlace && low.depth < nearest_at.depth - kSamePlace);
    if (!is_nearer) continue;
    nearest_at = low;
    const double at = forward ? begin : end;
    nearest = SurfaceHit{t, {}, Vec3d::Zero(), high.progress};
    for (std::size_t k = 0; k < 3; ++k) {
      nearest->barycentric[k] = (1 - at) * crossing->ends[0].barycentric[k] + at * crossing->ends[1].barycentric[k];
      nearest->position += nearest->barycentric[k] * corners[k];
    }
  }
  return nearest;
}

}  // namespace sunder::tear
