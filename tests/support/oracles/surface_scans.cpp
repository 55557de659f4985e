#include "support/oracles/surface_scans.h"

#include <algorithm>
#include <limits>

#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

using tear::BladePlane;
using tear::kSamePlaceSweeps;
using tear::PlaneSide;
using tear::SurfaceHit;
using tear::SweepCoordinates;

using Corners = std::array<Vec3d, 3>;

/// Calls visit(face, corners) for all live faces, in order.
template <class Visit>
void for_each_face(const tear::SurfaceEditor& editor, tear::PosedPoints& posed, Visit visit) {
  for (Index t = 0; t < editor.surface().triangle_count(); ++t) {
    if (editor.surface().has_repeated_point(t)) continue;
    const Index* points = &editor.surface().corner_point[3 * std::size_t{t}];
    const Corners corners = {posed.position(editor, points[0]), posed.position(editor, points[1]),
                             posed.position(editor, points[2])};
    visit(t, corners);
  }
}

/// Clips [begin, end] of the line from a to b to where `value` is not negative; false if nothing is
/// left.
bool clip(double at_a, double at_b, double& begin, double& end) {
  if (at_a < 0 && at_b < 0) return false;
  if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
  if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
  return begin <= end;
}

struct Contact {
  SurfaceHit hit;
  SweepCoordinates low;
};

std::vector<Contact> all_contacts(const BladePlane& plane, double progress,
                                  const tear::SurfaceEditor& editor, tear::PosedPoints& posed) {
  const BladePlane::HalfPlane not_before = plane.from_progress(progress);
  std::vector<Contact> contacts;
  for_each_face(editor, posed, [&](Index triangle, const Corners& corners) {
    std::array<std::array<double, 3>, 2> barycentric = {};
    std::array<Vec2d, 2> position;
    std::size_t found = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const double at_k = plane.distance(corners[k]), at_l = plane.distance(corners[l]);
      if ((at_k >= 0) == (at_l >= 0)) continue;
      const double t = at_k / (at_k - at_l);
      barycentric[found][k] = 1 - t;
      barycentric[found][l] = t;
      position[found++] = plane.project(corners[k] + t * (corners[l] - corners[k]));
    }
    if (found != 2) return;
    const Vec2d &a = position[0], &b = position[1];
    double begin = 0, end = 1;
    bool is_reached = clip(not_before.value(a), not_before.value(b), begin, end);
    for (const auto& side : plane.reach())
      is_reached = is_reached && clip(side.value(a), side.value(b), begin, end);
    if (!is_reached || end - begin < tear::kSnapEdges) return;
    const SweepCoordinates at_begin = plane.sweep_coordinates(a + begin * (b - a));
    const SweepCoordinates at_end = plane.sweep_coordinates(a + end * (b - a));
    const bool forward = at_begin.progress <= at_end.progress;
    const SweepCoordinates low = forward ? at_begin : at_end, high = forward ? at_end : at_begin;
    if (!(high.progress > std::max(low.progress, progress) + kSamePlaceSweeps)) return;
    Contact contact{{triangle, {}, Vec3d::Zero(), high.progress}, low};
    const double at = forward ? begin : end;
    for (std::size_t k = 0; k < 3; ++k) {
      contact.hit.barycentric[k] = (1 - at) * barycentric[0][k] + at * barycentric[1][k];
      contact.hit.position += contact.hit.barycentric[k] * corners[k];
    }
    contacts.push_back(contact);
  });
  return contacts;
}

}  // namespace

std::optional<SurfaceHit> scan_for_hit(const Blade& blade, const tear::SurfaceEditor& editor,
                                       tear::PosedPoints& posed) {
  const Vec3d direction = blade.tip - blade.base;
  // In the plane of a face the position is only rounding, so compare with the face's box along the
  // blade.
  const tear::Frame frame = posed.frame_along(tear::axes_along(direction), editor);
  const Vec3d base_in_axes = frame.place_of(blade.base), direction_in_axes = frame.axes * direction;
  const double reach =
      std::max({frame.reach(), blade.base.cwiseAbs().maxCoeff(), blade.tip.cwiseAbs().maxCoeff()});
  const auto clamp_to_box = [&](const Corners& corners, double& depth) {
    const Vec3d a = frame.place_of(corners[0]), b = frame.place_of(corners[1]),
                c = frame.place_of(corners[2]);
    const tear::FrameBox box =
        tear::FrameBox{a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}.widened(reach);
    double begin = 0, end = 1;
    for (int k = 0; k < 3; ++k) {
      if (direction_in_axes[k] == 0 &&
          (box.low[k] > base_in_axes[k] || box.high[k] < base_in_axes[k]))
        return false;
      if (direction_in_axes[k] == 0) continue;
      const double at_low = (box.low[k] - base_in_axes[k]) * (1 / direction_in_axes[k]);
      const double at_high = (box.high[k] - base_in_axes[k]) * (1 / direction_in_axes[k]);
      begin = std::max(begin, std::min(at_low, at_high));
      end = std::min(end, std::max(at_low, at_high));
    }
    depth = std::min(std::max(depth, begin), end);
    return begin <= end;
  };
  std::optional<SurfaceHit> nearest;
  double nearest_depth = 1.0;
  for_each_face(editor, posed, [&](Index t, const Corners& corners) {
    const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Vec3d h = direction.cross(ac);
    const double determinant = ab.dot(h);
    if (!(std::abs(determinant) > 1e-14 * ab.norm() * ac.norm() * direction.norm())) return;
    const Vec3d from_corner = blade.base - corners[0];
    const double u = from_corner.dot(h) / determinant;
    const Vec3d q = from_corner.cross(ab);
    const double v = direction.dot(q) / determinant;
    double depth = ac.dot(q) / determinant;
    constexpr double kEdge = 1e-12;
    if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge || depth < 0 || depth > 1 ||
        !clamp_to_box(corners, depth))
      return;
    if (depth > nearest_depth || (nearest && depth == nearest_depth)) return;
    nearest_depth = depth;
    nearest = SurfaceHit{t,
                         {std::max(0.0, 1 - u - v), std::max(0.0, u), std::max(0.0, v)},
                         blade.base + depth * direction,
                         0};
  });
  return nearest;
}

std::optional<SurfaceHit> scan_for_contact(const BladePlane& plane, double progress,
                                           const tear::SurfaceEditor& editor,
                                           tear::PosedPoints& posed) {
  const std::vector<Contact> contacts = all_contacts(plane, progress, editor, posed);
  double least = std::numeric_limits<double>::max(), least_depth = least;
  for (const Contact& contact : contacts) least = std::min(least, contact.low.progress);
  for (const Contact& contact : contacts)
    if (contact.low.progress < least + kSamePlaceSweeps)
      least_depth = std::min(least_depth, contact.low.depth);
  for (const Contact& contact : contacts)
    if (contact.low.progress < least + kSamePlaceSweeps &&
        contact.low.depth <= least_depth + kSamePlaceSweeps)
      return contact.hit;
  return std::nullopt;
}

std::vector<Index> scan_for_faces_in(const tear::Cell& cell, const tear::SurfaceEditor& editor,
                                     tear::PosedPoints& posed) {
  std::vector<Index> faces;
  std::vector<Vec3d> clipped;
  for_each_face(editor, posed, [&](Index face, const Corners& corners) {
    for (const PlaneSide& side : cell)
      if (std::none_of(corners.begin(), corners.end(),
                       [&](const Vec3d& corner) { return side.value(corner) > 0; }))
        return;
    std::vector<Vec3d> polygon(corners.begin(), corners.end());
    for (const PlaneSide& side : cell) {
      clipped.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double at_a = side.value(a), at_b = side.value(b);
        if (at_a > 0) clipped.push_back(a);
        if ((at_a > 0) != (at_b > 0)) clipped.push_back(a + at_a / (at_a - at_b) * (b - a));
      }
      polygon.swap(clipped);
      if (polygon.size() < 3) return;
    }
    faces.push_back(face);
  });
  return faces;
}

std::vector<Index> scan_for_faces_across(const tear::Sheet& sheet,
                                         const tear::SurfaceEditor& editor,
                                         tear::PosedPoints& posed) {
  std::vector<Index> faces;
  posed.compare_with(sheet.plane);
  for_each_face(editor, posed, [&](Index face, const Corners& corners) {
    const auto count_in = [&](const PlaneSide& side) {
      return std::count_if(corners.begin(), corners.end(),
                           [&](const Vec3d& corner) { return side.contains(corner); });
    };
    const auto in_front = count_in(sheet.plane);
    std::size_t on_plane = 0;
    for (std::size_t k = 0; k < 3; ++k)
      on_plane += posed.is_on_plane(editor, editor.surface().corner_point[3 * face + k]) ? 1 : 0;
    if (((in_front > 0 && in_front < 3) || on_plane >= 2) &&
        std::all_of(sheet.bounds.begin(), sheet.bounds.end(),
                    [&](const tear::Sheet::Bound& bound) { return count_in(bound.side) > 0; }))
      faces.push_back(face);
  });
  return faces;
}

}  // namespace sunder::test
