#include "pipeline/binding/sight.h"

#include <algorithm>
#include <limits>
#include <unsupported/Eigen/BVH>
#include <utility>
#include <vector>

#include <Eigen/StdVector>

#include "core/internal/ordered.h"

namespace sunder::binding {
namespace {

/// Share of the way at both ends where it may touch the surface, and of a triangle's sides beyond
/// them, so that no way slips through between two triangles.
constexpr double kTouches = 1e-6;

/// A direction along which edges and faces of models rarely lie.
const Vec3d kAskew(0.5377671, 0.6183399, 0.5731852);

/// Where a line meets the plane of a triangle. Source: Moller and Trumbore 1997 [moller1997fast].
struct Crossing {
  double volume = 0;  ///< Its sign tells the side from which the line comes; 0: parallel.
  double u = 0, v = 0, t = 0;

  [[nodiscard]] bool is_within(double slack) const {
    return volume != 0 && u >= -slack && v >= -slack && u + v <= 1 + slack;
  }
};

Crossing cross(const WeldedSurface& surface, Index triangle, const Vec3d& from, const Vec3d& way) {
  const auto& [first, second, third] = surface.triangles[triangle];
  const Vec3d& a = surface.positions[first];
  const Vec3d ab = surface.positions[second] - a, ac = surface.positions[third] - a;
  const Vec3d across = way.cross(ac), to_start = from - a, normal = to_start.cross(ab);
  Crossing crossing;
  crossing.volume = dot(ab, across);
  if (crossing.volume == 0) return crossing;
  crossing.u = dot(to_start, across) / crossing.volume;
  crossing.v = dot(way, normal) / crossing.volume;
  crossing.t = dot(ac, normal) / crossing.volume;
  return crossing;
}

/// Whether a line meets a box between two shares of its way.
bool meets(const Eigen::AlignedBox3d& box, const Vec3d& from, const Vec3d& way, double last) {
  double enter = 0, leave = last;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) {
      if (from[axis] < box.min()[axis] || from[axis] > box.max()[axis]) return false;
      continue;
    }
    const double t0 = (box.min()[axis] - from[axis]) / way[axis],
                 t1 = (box.max()[axis] - from[axis]) / way[axis];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave + kTouches;
}

/// Seeks a triangle that hides a place, for BVIntersect.
struct Way {
  const WeldedSurface& surface;
  Index point;
  Vec3d from, way;
  bool is_hidden = false;

  bool intersectVolume(const Eigen::AlignedBox3d& box) const { return meets(box, from, way, 1); }
  bool intersectObject(Index triangle) {
    const Triangle& points = surface.triangles[triangle];
    if (surface.part_of_point[points[0]] != surface.part_of_point[point]) return false;
    if (std::ranges::find(points, point) != points.end()) return false;
    const Crossing crossing = cross(surface, triangle, from, way);
    is_hidden = crossing.is_within(kTouches) && crossing.t > kTouches && crossing.t < 1 - kTouches;
    return is_hidden;
  }
};

/// Counts how often a part winds around a place, for BVIntersect: by what a ray crosses, faces from
/// behind minus faces from the front.
struct Winding {
  const WeldedSurface& surface;
  Index part;
  Vec3d from;
  int count = 0;

  bool intersectVolume(const Eigen::AlignedBox3d& box) const {
    return meets(box, from, kAskew, std::numeric_limits<double>::infinity());
  }
  bool intersectObject(Index triangle) {
    if (surface.part_of_point[surface.triangles[triangle][0]] != part) return false;
    const Crossing crossing = cross(surface, triangle, from, kAskew);
    if (crossing.is_within(0) && crossing.t > 0) count += crossing.volume > 0 ? 1 : -1;
    return false;  // go on
  }
};

}  // namespace

struct Sight::Tree {
  Eigen::KdBVH<double, 3, Index> boxes;
};

Sight::Sight(const WeldedSurface& surface) : surface_(surface) {
  std::vector<Index> triangles;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.has_area[t]) continue;
    triangles.push_back(t);
    auto& box = boxes.emplace_back();
    for (const Index point : surface.triangles[t])
      box.extend(Eigen::Vector3d(surface.positions[point]));
  }
  auto tree = std::make_unique<Tree>();
  if (!triangles.empty())
    tree->boxes.init(triangles.begin(), triangles.end(), boxes.begin(), boxes.end());
  tree_ = std::move(tree);
}

Sight::~Sight() = default;

bool Sight::is_inside(Index part, const Vec3d& place) const {
  Winding winding{surface_, part, place};
  Eigen::BVIntersect(tree_->boxes, winding);
  return winding.count != 0;
}

bool Sight::is_clear(Index point, const Vec3d& place) const {
  const Index part = surface_.part_of_point[point];
  const Vec3d& from = surface_.positions[point];
  Way way{surface_, point, from, place - from};
  Eigen::BVIntersect(tree_->boxes, way);
  return !way.is_hidden && (!surface_.is_closed[part] || is_inside(part, place));
}

}  // namespace sunder::binding
