#include "tear/sheet/section_corners.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/internal/ordered.h"

namespace sunder::tear {
namespace {

/// An edge at one of its ends.
struct EdgeEnd {
  Index point = kNone;  ///< At which the edge leaves or arrives.
  Index edge = kNone;
  bool leaves = false;
  double turn = 0;  ///< Direction away from the point: grows with the angle, from -2 to 2.
};

/// A number that grows with the angle of a direction, without trigonometry.
double turn_of(double x, double y) {
  const double size = std::abs(x) + std::abs(y);
  if (!(size > 0)) return 0;
  return y >= 0 ? 1 - x / size : x / size - 1;
}

/// The corners at one point, if leaving and arriving edges alternate.
void add_corners(std::span<EdgeEnd> ends, ScratchVector<SectionCorner>& corners) {
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
    return a.turn != b.turn ? a.turn < b.turn : a.edge < b.edge;
  });
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i].leaves == ends[(i + 1) % ends.size()].leaves) return;
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i].leaves)
      corners.push_back({ends[i].point, ends[(i + 1) % ends.size()].edge, ends[i].edge});
}

}  // namespace

ScratchVector<SectionCorner> find_section_corners(std::span<const PointEdge> edges,
                                                  const Vec3d& normal, const SurfaceEditor& editor,
                                                  PosedPoints& posed) {
  ScratchVector<EdgeEnd> ends(&editor.scratch());
  ends.reserve(2 * edges.size());
  for (Index i = 0; i < edges.size(); ++i) {
    ends.push_back({edges[i][0], i, true, 0});
    ends.push_back({edges[i][1], i, false, 0});
  }
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
    if (a.point != b.point) return a.point < b.point;
    return a.edge != b.edge ? a.edge < b.edge : a.leaves < b.leaves;
  });
  const Vec3d away = std::abs(normal.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY());
  const Vec3d x = normal.cross(away), y = normal.cross(x);
  ScratchVector<SectionCorner> corners(&editor.scratch());
  for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
    while (end < ends.size() && ends[end].point == ends[begin].point) ++end;
    if (end - begin < 4) continue;
    const Vec3d at = posed.position(editor, ends[begin].point);
    for (std::size_t i = begin; i < end; ++i) {
      const PointEdge& edge = edges[ends[i].edge];
      const Vec3d way = posed.position(editor, edge[ends[i].leaves ? 1 : 0]) - at;
      ends[i].turn = turn_of(dot(x, way), dot(y, way));
    }
    add_corners(std::span(ends).subspan(begin, end - begin), corners);
  }
  return corners;
}

}  // namespace sunder::tear
