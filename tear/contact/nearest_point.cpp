#include "tear/contact/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/contact/segment_hit.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

/// The parameters of the nearest points of two segments, each from its start `a` along `u`.
struct OnSegments {
  double first = 0, second = 0;
  double squared_distance = 0;
};

double part_along(const Vec3d& from, const Vec3d& way, const Vec3d& point) {
  const double square = squared_norm(way);
  return square > 0 ? std::clamp(dot(point - from, way) / square, 0.0, 1.0) : 0.0;
}

OnSegments nearest_of_segments(const Vec3d& a, const Vec3d& u, const Vec3d& b, const Vec3d& v) {
  const Vec3d between = a - b;
  const double uu = squared_norm(u), vv = squared_norm(v), uv = dot(u, v);
  const double area = uu * vv - uv * uv;
  OnSegments found;
  // Where the lines are nearest, if they are not parallel; then each parameter for the other one,
  // so that ends are respected.
  found.first = area > kFlatSquaredSizes * uu * vv
                    ? std::clamp((uv * dot(v, between) - vv * dot(u, between)) / area, 0.0, 1.0)
                    : 0.0;
  found.second = part_along(b, v, a + found.first * u);
  found.first = part_along(a, u, b + found.second * v);
  found.squared_distance = squared_norm(Vec3d(between + found.first * u - found.second * v));
  return found;
}

/// Takes the nearest place of an edge, if it is nearer.
void take_edge(const Vec3d& base, const Vec3d& way, const Corners& corners, std::size_t edge,
               NearestPlaces& nearest) {
  const std::size_t next = (edge + 1) % 3;
  const OnSegments on =
      nearest_of_segments(base, way, corners[edge], corners[next] - corners[edge]);
  if (!(on.squared_distance < nearest.squared_distance)) return;
  nearest.squared_distance = on.squared_distance;
  nearest.barycentric = {0, 0, 0};
  nearest.barycentric[edge] = 1 - on.second;
  nearest.barycentric[next] = on.second;
  nearest.along = on.first;
}

/// Takes the foot of a point, if it is inside the triangle and nearer.
void take_foot(const Vec3d& point, double along, const Corners& corners, NearestPlaces& nearest) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0],
              from_corner = point - corners[0];
  const Vec3d normal = ab.cross(ac);
  const double square = squared_norm(normal);
  if (!(square > kFlatSquaredSizes * kFlatSquaredSizes * squared_norm(ab) * squared_norm(ac)))
    return;
  const double v = dot(normal, from_corner.cross(ac)) / square,
               w = dot(normal, ab.cross(from_corner)) / square;
  if (!(v > 0 && w > 0 && v + w < 1)) return;
  const double height = dot(normal, from_corner);
  const double squared_distance = height * height / square;
  if (!(squared_distance < nearest.squared_distance)) return;
  nearest = {squared_distance, {1 - v - w, v, w}, along};
}

}  // namespace

NearestPlaces nearest_of_point(const Vec3d& point, const Corners& corners) {
  NearestPlaces nearest;
  nearest.squared_distance = std::numeric_limits<double>::infinity();
  take_foot(point, 0, corners, nearest);
  if (nearest.squared_distance < std::numeric_limits<double>::infinity()) return nearest;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const std::size_t next = (edge + 1) % 3;
    const Vec3d way = corners[next] - corners[edge];
    const double part = part_along(corners[edge], way, point);
    const double square = squared_norm(Vec3d(corners[edge] + part * way - point));
    if (!(square < nearest.squared_distance)) continue;
    nearest = {square, {0, 0, 0}, 0};
    nearest.barycentric[edge] = 1 - part;
    nearest.barycentric[next] = part;
  }
  return nearest;
}

NearestPlaces nearest_of_segment(const Vec3d& base, const Vec3d& tip, const Corners& corners) {
  const Vec3d way = tip - base;
  if (way.isZero(0)) return nearest_of_point(base, corners);
  if (const auto hit = hit_of_segment(base, way, corners); hit && hit->along <= 1)
    return {0, hit->barycentric, hit->along};
  NearestPlaces nearest;
  nearest.squared_distance = std::numeric_limits<double>::infinity();
  for (std::size_t edge = 0; edge < 3; ++edge) take_edge(base, way, corners, edge, nearest);
  take_foot(base, 0, corners, nearest);
  take_foot(tip, 1, corners, nearest);
  return nearest;
}

double squared_distance(const Corners& a, const Corners& b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const std::size_t next = (edge + 1) % 3;
    least = std::min({least, nearest_of_segment(a[edge], a[next], b).squared_distance,
                      nearest_of_segment(b[edge], b[next], a).squared_distance});
  }
  return least;
}

}  // namespace sunder::tear
