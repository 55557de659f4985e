#include "support/oracles/clip_oracle.h"

#include <cmath>
#include <numbers>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

using Polygon = std::vector<Vec3d>;

/// Sutherland and Hodgman, Reentrant polygon clipping, 1974.
Polygon clip(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double beyond_from = half_space.normal.dot(from) - half_space.offset,
                 beyond_to = half_space.normal.dot(to) - half_space.offset;
    if (beyond_from <= 0) inside.push_back(from);
    if ((beyond_from <= 0) != (beyond_to <= 0))
      inside.push_back(from + beyond_from / (beyond_from - beyond_to) * (to - from));
  }
  return inside;
}

double area_of(const Polygon& polygon) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return 0.5 * sum.norm();
}

std::vector<Polygon> posed_triangles(const Character& character, const ModelPose& pose) {
  std::vector<Polygon> triangles;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const auto posed = posed_positions(character, m, pose);
    for (const Triangle& triangle : character.meshes[m].triangles)
      if (!is_retired(triangle))
        triangles.push_back({posed[triangle[0]], posed[triangle[1]], posed[triangle[2]]});
  }
  return triangles;
}

std::vector<Polygon> clip_all(const std::vector<Polygon>& polygons,
                              std::span<const HalfSpace> cell) {
  std::vector<Polygon> inside;
  for (Polygon polygon : polygons) {
    for (const HalfSpace& half_space : cell) polygon = clip(polygon, half_space);
    if (polygon.size() > 2) inside.push_back(std::move(polygon));
  }
  return inside;
}

double area_of_union(const std::vector<Polygon>& polygons, std::span<const ConvexCell> cells) {
  double area = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // The part in this cell, without the parts in later cells.
    const std::vector<Polygon> inside = clip_all(polygons, cells[i]);
    for (const Polygon& polygon : inside) area += area_of(polygon);
    if (!inside.empty()) area -= area_of_union(inside, cells.subspan(i + 1));
  }
  return area;
}

}  // namespace

ConvexCell slab(const Vec3d& point, const Vec3d& normal, double half_thickness) {
  const Vec3d unit = normal.normalized();
  return {{unit, unit.dot(point) + half_thickness}, {-unit, half_thickness - unit.dot(point)}};
}

ConvexCell prism(const Vec3d& origin, const Vec3d& direction, double radius, double depth,
                 std::uint32_t sides) {
  const Vec3d axis = direction.normalized();
  const Vec3d right = axis.unitOrthogonal(), up = axis.cross(right);
  ConvexCell cell = {{-axis, -axis.dot(origin)}, {axis, axis.dot(origin) + depth}};
  const double inner = radius * std::cos(std::numbers::pi / sides);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / sides;
    const Vec3d normal = std::cos(angle) * right + std::sin(angle) * up;
    cell.push_back({normal, normal.dot(origin) + inner});
  }
  return cell;
}

double clipped_area(const Character& character, const ModelPose& pose,
                    std::span<const HalfSpace> convex_cell) {
  double area = 0;
  for (const Polygon& polygon : clip_all(posed_triangles(character, pose), convex_cell))
    area += area_of(polygon);
  return area;
}

double clipped_area_of_union(const Character& character, const ModelPose& pose,
                             std::span<const ConvexCell> cells) {
  return area_of_union(posed_triangles(character, pose), cells);
}

}  // namespace sunder::test
