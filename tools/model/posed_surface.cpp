#include "tools/model/posed_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace sunder::tools {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Bounds box_of(const Corners& corners) {
  Bounds bounds;
  for (const Vec3d& corner : corners) {
    bounds.least = bounds.least.cwiseMin(corner);
    bounds.greatest = bounds.greatest.cwiseMax(corner);
  }
  return bounds;
}

void extend(Bounds& bounds, const Bounds& other) {
  bounds.least = bounds.least.cwiseMin(other.least);
  bounds.greatest = bounds.greatest.cwiseMax(other.greatest);
}

/// A lower bound of the distance between what two boxes hold.
double distance_between(const Bounds& a, const Bounds& b) {
  const Vec3d gap = (a.least - b.greatest).cwiseMax(b.least - a.greatest).cwiseMax(Vec3d::Zero());
  return gap.norm();
}

/// Ericson, Real-Time Collision Detection, section 5.1.9.
NearestPlaces nearest_on_segments(const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
  const Vec3d along = q - p, across = s - r, between = p - r;
  const double a = along.dot(along), e = across.dot(across), f = across.dot(between);
  const double b = along.dot(across), c = along.dot(between);
  const double denominator = a * e - b * b;
  double at = denominator > 1e-14 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0;
  double other = e > 0 ? (b * at + f) / e : 0.0;
  if (e == 0 || other < 0 || other > 1) {
    other = std::clamp(other, 0.0, 1.0);
    at = a > 0 ? std::clamp((b * other - c) / a, 0.0, 1.0) : 0.0;
  }
  return {p + at * along, r + other * across};
}

double segment_distance(const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
  const NearestPlaces nearest = nearest_on_segments(p, q, r, s);
  return (nearest.of_first - nearest.of_second).norm();
}

/// The distance of a point from the inside of a triangle; infinite if it does not stand above it.
double height_above(const Corners& triangle, const Vec3d& point) {
  const Vec3d ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Vec3d normal = ab.cross(ac), from = point - triangle[0];
  const double squared = normal.squaredNorm();
  if (!(squared > 0)) return kInfinite;
  const double v = from.cross(ac).dot(normal) / squared, w = ab.cross(from).dot(normal) / squared;
  if (v < 0 || w < 0 || v + w > 1) return kInfinite;
  return std::abs(from.dot(normal)) / std::sqrt(squared);
}

/// The place of a triangle's plane below a point.
Vec3d foot_on(const Corners& triangle, const Vec3d& point) {
  const Vec3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
  return point - normal.dot(point - triangle[0]) * normal;
}

/// Where a line meets the inside of a triangle: the multiple of `direction`.
std::optional<double> hit(const Corners& triangle, const Vec3d& origin, const Vec3d& direction) {
  const Vec3d ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Vec3d p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return {};
  const Vec3d from = origin - triangle[0];
  const double u = from.dot(p) / determinant;
  const Vec3d q = from.cross(ab);
  const double v = direction.dot(q) / determinant;
  if (u < 0 || v < 0 || u + v > 1) return {};
  return ac.dot(q) / determinant;
}

bool pierces(const Corners& edges_of, const Corners& triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d along = edges_of[(i + 1) % 3] - edges_of[i];
    const std::optional<double> at = hit(triangle, edges_of[i], along);
    if (at && *at >= 0 && *at <= 1) return true;
  }
  return false;
}

/// Looks for a triangle of a run of a surface that is nearer to a part of a shape than the nearest
/// one so far.
void look_within(const PosedSurface& surface, std::size_t run, const Corners& part,
                 std::size_t index, Nearest& nearest) {
  const Bounds box = box_of(part);
  const std::size_t begin = run * PosedSurface::kRun,
                    end = std::min(begin + PosedSurface::kRun, surface.triangles.size());
  for (std::size_t i = begin; i < end; ++i) {
    const Corners& triangle = surface.triangles[i];
    if (distance_between(box, box_of(triangle)) >= nearest.distance) continue;
    const double distance = tools::distance_between(part, triangle);
    if (distance < nearest.distance) nearest = {distance, index, i};
  }
}

/// The solid angle of a triangle, divided by 4 pi; van Oosterom and Strackee 1983.
double winding_of(const Corners& triangle, const Vec3d& point) {
  const Vec3d a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  const double x = a.norm(), y = b.norm(), z = c.norm();
  const double below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
  return std::atan2(a.dot(b.cross(c)), below) / (2.0 * std::numbers::pi);
}

}  // namespace

Result<PosedSurface> pose_surface(const Character& character, const ModelPose& pose) {
  const Result<std::vector<DeformedMesh>> posed = deform_model(character, pose);
  if (!posed) return posed.error();
  PosedSurface surface;
  for (std::size_t m = 0; m < posed->size(); ++m) {
    const std::vector<Vec3f>& positions = (*posed)[m].positions;
    for (const Triangle& triangle : character.meshes[m].triangles) {
      if (is_retired(triangle)) continue;
      Corners corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = positions[triangle[i]].cast<double>();
      if (surface.triangles.size() % PosedSurface::kRun == 0) surface.run_bounds.emplace_back();
      surface.triangles.push_back(corners);
      extend(surface.run_bounds.back(), box_of(corners));
    }
  }
  for (const Bounds& bounds : surface.run_bounds) extend(surface.bounds, bounds);
  return surface;
}

double distance_between(const Corners& a, const Corners& b) {
  if (pierces(a, b) || pierces(b, a)) return 0.0;
  double least = kInfinite;
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, height_above(a, b[i]), height_above(b, a[i])});
    for (std::size_t j = 0; j < 3; ++j)
      least = std::min(least, segment_distance(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return least;
}

NearestPlaces nearest_places(const Corners& first, const Corners& second) {
  NearestPlaces nearest;
  double least = kInfinite;
  const auto offer = [&](const NearestPlaces& places) {
    const double distance = (places.of_first - places.of_second).norm();
    if (!(distance < least)) return;
    least = distance;
    nearest = places;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (height_above(first, second[i]) < kInfinite) offer({foot_on(first, second[i]), second[i]});
    if (height_above(second, first[i]) < kInfinite) offer({first[i], foot_on(second, first[i])});
    for (std::size_t j = 0; j < 3; ++j)
      offer(nearest_on_segments(first[i], first[(i + 1) % 3], second[j], second[(j + 1) % 3]));
  }
  return nearest;
}

Nearest find_nearest(const PosedSurface& surface, std::span<const Corners> shape, double enough) {
  Nearest nearest;
  std::vector<std::pair<double, std::size_t>> runs;  // by lower bounds of their distances
  for (std::size_t part = 0; part < shape.size(); ++part) {
    const Bounds box = box_of(shape[part]);
    runs.clear();
    for (std::size_t i = 0; i < surface.run_bounds.size(); ++i) {
      const double bound = distance_between(box, surface.run_bounds[i]);
      if (bound < nearest.distance) runs.emplace_back(bound, i);
    }
    std::ranges::sort(runs);
    for (const auto& [bound, run] : runs) {
      if (bound >= nearest.distance) break;
      look_within(surface, run, shape[part], part, nearest);
      if (nearest.distance <= enough) return nearest;
    }
  }
  return nearest;
}

std::optional<double> first_hit(const PosedSurface& surface, const Vec3d& origin,
                                const Vec3d& direction, double after) {
  std::optional<double> first;
  for (const Corners& triangle : surface.triangles) {
    const std::optional<double> at = hit(triangle, origin, direction);
    if (at && *at > after && (!first || *at < *first)) first = at;
  }
  return first;
}

bool is_inside(const PosedSurface& surface, const Vec3d& point) {
  if (!surface.bounds.contains(point)) return false;
  double winding = 0;
  for (const Corners& triangle : surface.triangles) winding += winding_of(triangle, point);
  return winding > 0.5;
}

}  // namespace sunder::tools
