#include "tear/path/snapping.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

/// A length as a fraction of another, kept where it can serve as a snapping distance.
double fraction_of(double length, double whole) {
  return whole > 0 ? std::clamp(length / whole, kTightSnapEdges, kFarthestSnapEdges)
                   : kTightSnapEdges;
}

double largest_coordinate(const Vec3f& a, const Vec3f& b) {
  return static_cast<double>(std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()));
}

}  // namespace

double stored_height(Index corner, const SurfaceEditor& editor) {
  const Index mesh = editor.surface().triangle(corner / 3).mesh;
  const auto at = [&](Index c) -> const Vec3f& {
    return editor.births.position(mesh, editor.vertex_at(c));
  };
  const Vec3f &apex = at(corner), &a = at(Surface::next(corner)),
              &b = at(Surface::previous(corner));
  const Eigen::Vector3d base = b.cast<double>() - a.cast<double>(),
                        side = apex.cast<double>() - a.cast<double>();
  const double length = norm(base);
  return fraction_of(
      kStoredCoordinates * std::max(largest_coordinate(a, b), largest_coordinate(apex, apex)),
      length > 0 ? norm(base.cross(side)) / length : 0);
}

double stored_part(Index half_edge, const SurfaceEditor& editor) {
  const Index mesh = editor.surface().triangle(half_edge / 3).mesh;
  const Vec3f &from = editor.births.position(mesh, editor.vertex_at(half_edge)),
              &to = editor.births.position(mesh, editor.vertex_at(Surface::next(half_edge)));
  return fraction_of(kStoredCoordinates * largest_coordinate(from, to),
                     norm(to.cast<double>() - from.cast<double>()));
}

double snapped_part(Index half_edge, Snapping snapping, const SurfaceEditor& editor,
                    PosedPoints& posed) {
  if (snapping == Snapping::tight) return stored_part(half_edge, editor);
  if (snapping == Snapping::near) return kSnapEdges;
  if (editor.is_source_vertex(half_edge) && editor.is_source_vertex(Surface::next(half_edge)))
    return kSnapEdges;
  const Surface& surface = editor.surface();
  double length_squared = 0, longest_squared = 0;
  for (const Index side : {half_edge, surface.twin[half_edge]}) {
    if (side == kNone) continue;
    const Vec3d a = posed.position(editor, surface.corner_point[side]);
    const Vec3d b = posed.position(editor, surface.corner_point[Surface::next(side)]);
    const Vec3d c = posed.position(editor, surface.corner_point[Surface::previous(side)]);
    length_squared = squared_norm(b - a);
    longest_squared =
        std::max({longest_squared, length_squared, squared_norm(c - a), squared_norm(c - b)});
  }
  return length_squared > 0
             ? std::min(0.5, kSliverSizes * std::sqrt(longest_squared / length_squared))
             : 0.5;
}

}  // namespace sunder::tear
