#include "tools/tear/reach.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

namespace sunder::tools {
namespace {

/// The triangles of one segment of a stroke.
void add_segment(const Blade& from, const Blade& to, std::vector<Corners>& shape) {
  shape.push_back({from.base, from.tip, to.base});
  shape.push_back({from.tip, to.tip, to.base});
}

std::vector<Reach> reaches_of_tear(const TearOperation& tear) {
  std::vector<Reach> reaches(1);
  reaches[0].pose = tear.pose;
  reaches[0].first_blade = 1;
  auto change = tear.pose_changes.begin();
  for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
    if (change != tear.pose_changes.end() && change->blade == i) {
      reaches.push_back({});
      reaches.back().pose = change->pose;
      reaches.back().first_blade = static_cast<std::uint32_t>(i);
      ++change;
    }
    add_segment(tear.stroke[i - 1], tear.stroke[i], reaches.back().shape);
  }
  std::erase_if(reaches, [](const Reach& reach) { return reach.shape.empty(); });
  return reaches;
}

Reach reach_of_cut(const CutOperation& operation) {
  const PlaneCut& cut = operation.cut;
  Reach reach;
  reach.pose = operation.pose;
  if (cut.bounds.empty()) {
    reach.plane = cut;
    return reach;
  }
  const Vec3d normal = cut.normal.normalized();
  std::vector<Vec3d> corners;
  for (const Vec3d& corner : cut.bounds)
    corners.push_back(corner - normal.dot(corner - cut.point) * normal);
  for (std::size_t i = 2; i < corners.size(); ++i)
    reach.shape.push_back({corners[0], corners[i - 1], corners[i]});
  return reach;
}

Reach reach_of_bore(const DrillOperation& operation) {
  const Bore& bore = operation.bore;
  Reach reach;
  reach.pose = operation.pose;
  reach.radius = bore.radius;
  const Vec3d end = bore.origin + bore.depth * bore.direction.normalized();
  reach.shape.push_back({bore.origin, end, end});
  return reach;
}

/// The distance of a whole plane from a surface on one side of it.
double distance_from_plane(const PosedSurface& surface, const PlaneCut& plane) {
  const Vec3d normal = plane.normal.normalized();
  double below = std::numeric_limits<double>::infinity(), above = below;
  for (const Corners& corners : surface.triangles)
    for (const Vec3d& corner : corners) {
      const double height = normal.dot(corner - plane.point);
      below = std::min(below, height);
      above = std::min(above, -height);
    }
  return std::max({below, above, 0.0});
}

}  // namespace

std::vector<Reach> reaches_of(const Operation& operation) {
  if (const auto* const tear = std::get_if<TearOperation>(&operation))
    return reaches_of_tear(*tear);
  if (const auto* const cut = std::get_if<CutOperation>(&operation)) return {reach_of_cut(*cut)};
  if (const auto* const bore = std::get_if<DrillOperation>(&operation))
    return {reach_of_bore(*bore)};
  return {};
}

double distance_between(const PosedSurface& surface, const Reach& reach, double enough) {
  return reach.plane ? distance_from_plane(surface, *reach.plane)
                     : distance_between(surface, reach.shape, enough);
}

bool meets(const PosedSurface& surface, const Reach& reach) {
  return distance_between(surface, reach, reach.radius) <= reach.radius;
}

Bounds bounds_of(const Reach& reach) {
  Bounds bounds;
  const auto add = [&](const Vec3d& point) {
    bounds.least = bounds.least.cwiseMin(point);
    bounds.greatest = bounds.greatest.cwiseMax(point);
  };
  if (reach.plane) add(reach.plane->point);
  for (const Corners& corners : reach.shape)
    for (const Vec3d& corner : corners) add(corner);
  return bounds;
}

Operation scaled(const Operation& operation, double factor) {
  Operation result = operation;
  if (auto* const tear = std::get_if<TearOperation>(&result)) {
    for (Blade& blade : tear->stroke) blade.base *= factor, blade.tip *= factor;
  } else if (auto* const cut = std::get_if<CutOperation>(&result)) {
    cut->cut.point *= factor;
    for (Vec3d& corner : cut->cut.bounds) corner *= factor;
    for (Vec3d& place : cut->cut.sections) place *= factor;
    if (cut->cut.first_hit) cut->cut.first_hit->origin *= factor;
  } else if (auto* const bore = std::get_if<DrillOperation>(&result)) {
    bore->bore.origin *= factor;
    bore->bore.radius *= factor;
    bore->bore.depth *= factor;
  }
  return result;
}

Operation enlarged(const Operation& operation, double factor) {
  Operation result = operation;
  auto* const tear = std::get_if<TearOperation>(&result);
  if (tear == nullptr || tear->stroke.empty()) return result;
  Vec3d middle = Vec3d::Zero();
  for (const Blade& blade : tear->stroke) middle += blade.base;
  middle /= static_cast<double>(tear->stroke.size());
  for (Blade& blade : tear->stroke) {
    const Vec3d move = (factor - 1) * (blade.base - middle);
    blade.base += move;
    blade.tip += move;
  }
  return result;
}

Operation in_pose(const Operation& operation, const PoseSpec& pose) {
  Operation result = operation;
  if (auto* const tear = std::get_if<TearOperation>(&result)) {
    tear->pose = pose;
    tear->pose_changes.clear();
  } else if (auto* const cut = std::get_if<CutOperation>(&result)) {
    cut->pose = pose;
  } else if (auto* const bore = std::get_if<DrillOperation>(&result)) {
    bore->pose = pose;
  }
  return result;
}

Operation turned_round(const Operation& operation) {
  Operation result = operation;
  if (auto* const tear = std::get_if<TearOperation>(&result)) {
    for (Blade& blade : tear->stroke) blade.tip = 2 * blade.base - blade.tip;
  } else if (auto* const bore = std::get_if<DrillOperation>(&result)) {
    bore->bore.direction = -bore->bore.direction;
  }
  return result;
}

Operation lengthened(const Operation& operation, double length) {
  Operation result = operation;
  if (auto* const tear = std::get_if<TearOperation>(&result)) {
    for (Blade& blade : tear->stroke)
      blade.tip = blade.base + length * (blade.tip - blade.base).normalized();
  } else if (auto* const bore = std::get_if<DrillOperation>(&result)) {
    bore->bore.depth = length;
  }
  return result;
}

}  // namespace sunder::tools
