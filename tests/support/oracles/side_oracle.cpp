#include "support/oracles/side_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "support/machine/say.h"

namespace sunder::test {
namespace {

/// The fraction of the body's volume and area by which results may differ.
constexpr double kRounding = 1e-6;
/// The fraction of the largest coordinate within which a corner counts as in the plane.
constexpr double kInPlane = 1e-6;

using SidePolygon = std::vector<Vec3d>;

SidePolygon clip(const SidePolygon& polygon, const Vec3d& point, const Vec3d& normal) {
  SidePolygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double at_from = normal.dot(from - point), at_to = normal.dot(to - point);
    if (at_from >= 0) kept.push_back(from);
    if ((at_from < 0) != (at_to < 0))
      kept.push_back(from + at_from / (at_from - at_to) * (to - from));
  }
  return kept;
}

Vec3d doubled_area(const SidePolygon& polygon) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return sum;
}

/// Six times the volume of the pyramid over a polygon.
double six_volumes(const SidePolygon& polygon, const Vec3d& apex) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += (polygon[0] - apex).dot((polygon[i - 1] - apex).cross(polygon[i] - apex));
  return sum;
}

struct Sum {
  double area = 0;
  Vec3d vector = Vec3d::Zero();

  void add(const Vec3d& doubled) {
    area += 0.5 * doubled.norm();
    vector += 0.5 * doubled;
  }
};

ExactSide side_of(const Solid& body, const Vec3d& point, const Vec3d& normal, double near) {
  ExactSide side;
  Sum by_normal, clipped;
  for (const Triangle& triangle : body.triangles) {
    const SidePolygon face = {body.positions[triangle[0]], body.positions[triangle[1]],
                              body.positions[triangle[2]]};
    const SidePolygon part = clip(face, point, normal);
    side.volume += six_volumes(part, point) / 6;
    clipped.add(doubled_area(part));
    const bool is_in_plane = std::all_of(face.begin(), face.end(), [&](const Vec3d& corner) {
      return std::abs(normal.dot(corner - point)) <= near;
    });
    if (!is_in_plane)
      by_normal.add(doubled_area(part));
    else if (normal.dot(doubled_area(face)) < 0)  // the material behind it is on this side
      by_normal.add(doubled_area(face));
  }
  const auto capped = [&](const Sum& sum) { return sum.area + std::abs(normal.dot(sum.vector)); };
  side.least_area = std::min(by_normal.area, clipped.area);
  side.most_area = std::max(by_normal.area, clipped.area);
  side.least_capped_area = std::min(capped(by_normal), capped(clipped));
  side.most_capped_area = std::max(capped(by_normal), capped(clipped));
  return side;
}

bool is_closed(const Solid& surface) {
  std::map<std::array<std::uint32_t, 2>, int> balance;  // of edges, from the lower vertex
  for (const Triangle& triangle : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  return std::all_of(balance.begin(), balance.end(), [](const auto& of) { return of.second == 0; });
}

}  // namespace

ExactSides exact_sides(const Solid& body, const Vec3d& point, const Vec3d& normal) {
  double farthest = 0;
  for (const Vec3d& position : body.positions)
    farthest = std::max(farthest, position.cwiseAbs().maxCoeff());
  ExactSides exact;
  exact.sides = {side_of(body, point, -normal, kInPlane * farthest),
                 side_of(body, point, normal, kInPlane * farthest)};
  for (const Triangle& triangle : body.triangles) {
    const SidePolygon face = {body.positions[triangle[0]], body.positions[triangle[1]],
                              body.positions[triangle[2]]};
    exact.volume += six_volumes(face, point) / 6;
    exact.area += 0.5 * doubled_area(face).norm();
  }
  return exact;
}

std::string fault_of_side(const Solid& surface, bool is_capped, std::size_t side,
                          const ExactSides& exact, const Vec3d& point) {
  const ExactSide& wanted = exact.sides[side];
  double area = 0, volume = 0;
  for (const Triangle& triangle : surface.triangles) {
    const SidePolygon face = {surface.positions[triangle[0]], surface.positions[triangle[1]],
                              surface.positions[triangle[2]]};
    area += 0.5 * doubled_area(face).norm();
    volume += six_volumes(face, point) / 6;
  }
  const char* const name = side == 0 ? "below" : "above";
  const double least = is_capped ? wanted.least_capped_area : wanted.least_area,
               most = is_capped ? wanted.most_capped_area : wanted.most_area;
  if (is_capped && !is_closed(surface)) return say(name, ": open");
  if (!(area >= least - kRounding * exact.area && area <= most + kRounding * exact.area))
    return say(name, ": area ", area, " instead of ", least, " to ", most);
  if (is_capped && !(std::abs(volume - wanted.volume) <= kRounding * exact.volume))
    return say(name, ": volume ", volume, " instead of ", wanted.volume);
  return {};
}

}  // namespace sunder::test
