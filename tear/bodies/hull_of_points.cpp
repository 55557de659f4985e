#include "tear/bodies/hull_of_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/bodies/qhull.h"

namespace sunder::bodies {
namespace {

/// Points that lie nearer to a plane, a line or a point than this, in sizes of all of them, lie on
/// it.
constexpr double kFlat = 1e-9;

using Indices = std::vector<std::uint32_t>;

/// Up to four points that span as much as a point, a line, a plane or all of space.
Indices spanning_points(std::span<const Vec3d> points) {
  Indices chosen = {0};
  const auto add_farthest = [&](auto away) {
    double most = kFlat;
    std::uint32_t farthest = kNone;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (const double distance = away(points[i]); distance > most) {
        most = distance;
        farthest = i;
      }
    if (farthest != kNone) chosen.push_back(farthest);
    return farthest != kNone;
  };
  const auto at = [&](std::size_t i) -> const Vec3d& { return points[chosen[i]]; };
  if (!add_farthest([&](const Vec3d& p) { return norm(Vec3d(p - at(0))); })) return chosen;
  std::swap(chosen[0], chosen[1]);
  chosen.pop_back();  // any first point would do for a plane, but a line has two ends
  add_farthest([&](const Vec3d& p) { return norm(Vec3d(p - at(0))); });
  const Vec3d along = normalized(Vec3d(at(1) - at(0)));
  if (!add_farthest([&](const Vec3d& p) { return norm(along.cross(Vec3d(p - at(0)))); }))
    return chosen;
  const Vec3d normal = normalized(Vec3d(along.cross(Vec3d(at(2) - at(0)))));
  add_farthest([&](const Vec3d& p) { return std::abs(dot(normal, Vec3d(p - at(0)))); });
  return chosen;
}

/// The corners of the hull of points in a plane, in order: Andrew's monotone chain, 1979
/// [andrew1979hull].
Indices flat_hull(std::span<const Vec3d> points, const Indices& spanning) {
  const Vec3d& origin = points[spanning[0]];
  const Vec3d right = normalized(Vec3d(points[spanning[1]] - origin)),
              normal = normalized(Vec3d(right.cross(Vec3d(points[spanning[2]] - origin)))),
              up = normal.cross(right);
  struct Flat {
    double x, y;
    std::uint32_t index;
  };
  std::vector<Flat> flat;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    flat.push_back({dot(right, Vec3d(points[i] - origin)), dot(up, Vec3d(points[i] - origin)), i});
  std::sort(flat.begin(), flat.end(), [](const Flat& a, const Flat& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.index < b.index;
  });
  std::vector<Flat> chain;
  const auto walk = [&](auto begin, auto end) {
    const std::size_t first = chain.size();
    for (auto at = begin; at != end; ++at) {
      while (chain.size() >= first + 2) {
        const Flat &a = chain[chain.size() - 2], &b = chain.back();
        if ((b.x - a.x) * (at->y - a.y) - (b.y - a.y) * (at->x - a.x) > 0) break;
        chain.pop_back();
      }
      chain.push_back(*at);
    }
    chain.pop_back();  // the other chain begins there
  };
  walk(flat.begin(), flat.end());
  walk(flat.rbegin(), flat.rend());
  Indices corners;
  for (const Flat& corner : chain) corners.push_back(corner.index);
  return corners;
}

/// A hull in terms of the given points.
struct Faces {
  Indices points;  ///< The corners.
  std::vector<Triangle> triangles;
};

Faces both_sides(const Indices& corners) {
  Faces faces{corners, {}};
  for (std::size_t i = 2; i < corners.size(); ++i) {
    faces.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    faces.triangles.push_back({corners[0], corners[i], corners[i - 1]});
  }
  return faces;
}

/// The hull of those of the points that are `chosen`, of which at least four are not in a plane.
Faces solid_hull(std::span<const Vec3d> points, const Indices& chosen) {
  std::vector<Vec3d> of_chosen;
  Vec3d middle = Vec3d::Zero();
  for (const std::uint32_t i : chosen) {
    of_chosen.push_back(points[i]);
    middle += points[i] / static_cast<double>(chosen.size());
  }
  Faces faces;
  for (Triangle triangle : hull_faces(of_chosen)) {
    for (std::uint32_t& corner : triangle) corner = chosen[corner];
    const Vec3d &a = points[triangle[0]], &b = points[triangle[1]], &c = points[triangle[2]];
    if (dot(Vec3d((b - a).cross(c - a)), Vec3d(a - middle)) < 0)
      std::swap(triangle[1], triangle[2]);
    faces.triangles.push_back(triangle);
    faces.points.insert(faces.points.end(), triangle.begin(), triangle.end());
  }
  std::sort(faces.points.begin(), faces.points.end());
  faces.points.erase(std::unique(faces.points.begin(), faces.points.end()), faces.points.end());
  return faces;
}

/// A face's plane. Faces without area have none.
struct Plane {
  Vec3d normal;
  double offset;

  [[nodiscard]] double height(const Vec3d& point) const { return dot(normal, point) - offset; }
};

std::vector<Plane> planes_of(const Faces& faces, std::span<const Vec3d> points) {
  std::vector<Plane> planes;
  for (const Triangle& triangle : faces.triangles) {
    const Vec3d& a = points[triangle[0]];
    const Vec3d normal = Vec3d(points[triangle[1]] - a).cross(Vec3d(points[triangle[2]] - a));
    if (!(norm(normal) > kFlat * kFlat)) continue;
    const Vec3d unit = normalized(normal);
    planes.push_back({unit, dot(unit, a)});
  }
  return planes;
}

struct Farthest {
  std::uint32_t point = kNone;
  double away = 0.0;
};

/// The candidate that is farthest above a face's plane.
Farthest farthest_outside(const Faces& faces, const Indices& candidates,
                          std::span<const Vec3d> points) {
  const std::vector<Plane> planes = planes_of(faces, points);
  Farthest farthest;
  for (const std::uint32_t i : candidates)
    for (const Plane& plane : planes)
      if (const double away = plane.height(points[i]); away > farthest.away) farthest = {i, away};
  return farthest;
}

/// The farthest candidate above each face's plane, the farthest of all first; each once.
Indices farthest_of_faces(const Faces& faces, const Indices& candidates,
                          std::span<const Vec3d> points) {
  std::vector<Farthest> of_faces;
  for (const Plane& plane : planes_of(faces, points)) {
    Farthest farthest;
    for (const std::uint32_t i : candidates)
      if (const double away = plane.height(points[i]); away > farthest.away) farthest = {i, away};
    if (farthest.point != kNone) of_faces.push_back(farthest);
  }
  std::sort(of_faces.begin(), of_faces.end(), [](const Farthest& a, const Farthest& b) {
    return a.away != b.away ? a.away > b.away : a.point < b.point;
  });
  Indices farthest;
  for (const Farthest& of_face : of_faces)
    if (std::find(farthest.begin(), farthest.end(), of_face.point) == farthest.end())
      farthest.push_back(of_face.point);
  return farthest;
}

/// The hull of at most `count` of the corners of a hull: those farthest outside are added. Several
/// at a time, because each time takes a hull.
Faces few_corners(const Faces& all, Indices chosen, std::uint32_t count,
                  std::span<const Vec3d> points) {
  Faces faces = solid_hull(points, chosen);
  while (chosen.size() < count) {
    std::size_t more = std::min<std::size_t>(count - chosen.size(), (chosen.size() + 3) / 4);
    const std::size_t before = chosen.size();
    for (const std::uint32_t point : farthest_of_faces(faces, all.points, points)) {
      if (more == 0) break;
      if (std::find(chosen.begin(), chosen.end(), point) != chosen.end()) continue;
      chosen.push_back(point);
      --more;
    }
    if (chosen.size() == before) break;
    faces = solid_hull(points, chosen);
  }
  return faces;
}

/// Every n-th corner of a polygon.
Indices few_corners(const Indices& corners, std::uint32_t count) {
  if (corners.size() <= count) return corners;
  Indices few;
  for (std::size_t i = 0; i < count; ++i) few.push_back(corners[i * corners.size() / count]);
  return few;
}

bool turns_left(const Indices& corners, const Vec3d& normal, std::span<const Vec3d> points) {
  Vec3d doubled_area = Vec3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i)
    doubled_area += Vec3d(points[corners[i - 1]] - points[corners[0]])
                        .cross(Vec3d(points[corners[i]] - points[corners[0]]));
  return dot(doubled_area, normal) > 0;
}

/// A hull and how far outside of it the farthest point is.
struct Hull {
  Faces faces;
  double outside = 0.0;
};

Hull hull_in_plane(std::span<const Vec3d> points, const Indices& spanning, std::uint32_t count) {
  const Indices corners = flat_hull(points, spanning);
  Hull hull{both_sides(few_corners(corners, count))};
  const Indices& kept = hull.faces.points;
  const Vec3d normal = normalized(Vec3d(points[spanning[1]] - points[spanning[0]])
                                      .cross(Vec3d(points[spanning[2]] - points[spanning[0]])));
  const double turn = turns_left(kept, normal, points) ? 1 : -1;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Vec3d& a = points[kept[i]];
    const Vec3d along = points[kept[(i + 1) % kept.size()]] - a;
    const Vec3d outward = turn * normalized(Vec3d(along.cross(normal)));
    for (const std::uint32_t corner : corners)
      hull.outside = std::max(hull.outside, dot(outward, Vec3d(points[corner] - a)));
  }
  return hull;
}

Hull hull_in_space(std::span<const Vec3d> points, const Indices& spanning, std::uint32_t count) {
  Indices all(points.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  Hull hull{solid_hull(points, all)};
  if (hull.faces.points.size() <= count) return hull;
  const Faces full = std::move(hull.faces);
  hull.faces = few_corners(full, spanning, count, points);
  hull.outside = farthest_outside(hull.faces, full.points, points).away;
  return hull;
}

double volume_of(const Faces& faces, std::span<const Vec3d> points) {
  double sum = 0;
  const Vec3d& origin = points[faces.points.front()];
  for (const auto& [a, b, c] : faces.triangles)
    sum += dot(Vec3d(points[a] - origin),
               Vec3d(Vec3d(points[b] - origin).cross(Vec3d(points[c] - origin))));
  return std::max(0.0, sum / 6);
}

}  // namespace

ConvexHull hull_of_points(std::span<const Vec3d> given, std::uint32_t maximum_points) {
  // One unit in size, so that no scale is too small or too large.
  Vec3d least = given[0], most = given[0];
  for (const Vec3d& point : given) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  const Vec3d middle = 0.5 * least + 0.5 * most;
  const double half = Vec3d(0.5 * most - 0.5 * least).maxCoeff(), unit = half > 0 ? half : 1;
  std::vector<Vec3d> points;
  for (const Vec3d& point : given) points.push_back((point - middle) / unit);

  const Indices spanning = spanning_points(points);
  Hull found{{spanning, {}}};
  if (spanning.size() == 4) found = hull_in_space(points, spanning, maximum_points);
  // Qhull takes bodies that are thin enough for flat.
  if (spanning.size() == 3 || (spanning.size() == 4 && found.faces.triangles.empty()))
    found = hull_in_plane(points, spanning, maximum_points);
  ConvexHull hull;
  hull.volume = volume_of(found.faces, points) * unit * unit * unit;
  hull.farthest_outside = found.outside * unit;
  Indices number(points.size(), kNone);
  for (const std::uint32_t point : found.faces.points) {
    number[point] = static_cast<std::uint32_t>(hull.points.size());
    hull.points.push_back(given[point]);
  }
  for (const auto& [a, b, c] : found.faces.triangles)
    hull.triangles.push_back({number[a], number[b], number[c]});
  return hull;
}

}  // namespace sunder::bodies
