#include "tear/path/snapping.h"

#include <algorithm>
#include <array>
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

/// Whether an edge is part of a lip that a tear made.
bool is_torn_lip(Index half_edge, const SurfaceEditor& editor) {
  return is_lip(half_edge, editor) &&
         !(editor.is_source_vertex(half_edge) && editor.is_source_vertex(Surface::next(half_edge)));
}

/// Whether such an edge begins in the point of a corner.
bool is_on_torn_lip(Index corner, const SurfaceEditor& editor) {
  bool is_on = false;
  editor.surface().for_each_in_fan(corner,
                                   [&](Index c) { is_on = is_on || is_torn_lip(c, editor); });
  return is_on;
}

/// The corners of a face, in any space.
struct SnappedCorners {
  std::array<Vec3d, 3> at;

  [[nodiscard]] double longest_side() const {
    return std::max(
        {norm(Vec3d(at[1] - at[0])), norm(Vec3d(at[2] - at[1])), norm(Vec3d(at[0] - at[2]))});
  }
  /// Over the side from corner `k` to the next one.
  [[nodiscard]] double height_over(std::size_t k) const {
    const Vec3d side = at[(k + 1) % 3] - at[k];
    const double length = norm(side);
    return length > 0 ? norm(Vec3d(side.cross(at[(k + 2) % 3] - at[k]))) / length : 0;
  }
};

SnappedCorners posed_corners(Index face, const SurfaceEditor& editor, PosedPoints& posed) {
  SnappedCorners corners;
  for (Index k = 0; k < 3; ++k)
    corners.at[k] = posed.position(editor, editor.surface().corner_point[3 * face + k]);
  return corners;
}

/// As barycentric coordinates in the triangle that the face is a part of.
Vec3d place_in_origin(Index corner, const SurfaceEditor& editor) {
  const auto [a, b, c] = editor.source_barycentric(corner);
  return {a, b, c};
}
SnappedCorners corners_in_origin(Index face, const SurfaceEditor& editor) {
  return {{place_in_origin(3 * face, editor), place_in_origin(3 * face + 1, editor),
           place_in_origin(3 * face + 2, editor)}};
}

}  // namespace

bool is_lip(Index half_edge, const SurfaceEditor& editor) {
  const Index across = editor.surface().twin[half_edge];
  return across == kNone || editor.is_wall(half_edge / 3) != editor.is_wall(across / 3);
}

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

double snapped_height(Index corner, Snapping snapping, const SurfaceEditor& editor,
                      PosedPoints& posed) {
  if (snapping == Snapping::tight) return stored_height(corner, editor);
  const Index base = Surface::next(corner);
  if (snapping == Snapping::near || !is_torn_lip(base, editor)) return kSnapEdges;
  const SnappedCorners face = posed_corners(corner / 3, editor, posed);
  const double height = face.height_over(base % 3), sliver = kSliverSizes * face.longest_side();
  const double in_origin = corners_in_origin(corner / 3, editor).height_over(base % 3);
  if (!(height > 0 && in_origin > 0)) return kFarthestSnapEdges;
  return std::min(kFarthestSnapEdges, std::max(sliver / height, kSnapEdges / in_origin));
}

bool is_at_lip_corner(const SurfaceHit& hit, Index corner, Snapping snapping,
                      const SurfaceEditor& editor, PosedPoints& posed) {
  if (snapping == Snapping::tight || snapping == Snapping::near || !is_on_torn_lip(corner, editor))
    return false;
  const SnappedCorners in_origin = corners_in_origin(hit.triangle, editor);
  Vec3d place = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) place += hit.barycentric[k] * in_origin.at[k];
  if (norm(Vec3d(place - in_origin.at[corner % 3])) < kSnapEdges) return true;
  const SnappedCorners face = posed_corners(hit.triangle, editor, posed);
  return norm(Vec3d(hit.position - face.at[corner % 3])) < kSliverSizes * face.longest_side();
}

double snapped_part(Index half_edge, Snapping snapping, const SurfaceEditor& editor,
                    PosedPoints& posed) {
  if (snapping == Snapping::tight) return stored_part(half_edge, editor);
  if (snapping == Snapping::near ||
      (snapping == Snapping::near_or_lip && !is_torn_lip(half_edge, editor)))
    return kSnapEdges;
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
