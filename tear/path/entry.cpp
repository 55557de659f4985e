#include "tear/path/entry.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/path/blade_segment.h"

namespace sunder::tear {
namespace {

/// The part of a triangle that lies in the plane, as two points on its edges.
struct PlaneSection {
  struct End {
    std::array<double, 3> barycentric = {0, 0, 0};
    Vec2d position = Vec2d::Zero();  ///< In the plane.
  };
  std::array<End, 2> ends;
};

std::optional<PlaneSection> cross_triangle(const BladePlane& plane, const FaceCorners& corners) {
  std::array<double, 3> distance;
  for (std::size_t k = 0; k < 3; ++k) distance[k] = plane.distance(corners[k]);
  PlaneSection section;
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    if ((distance[k] >= 0) == (distance[l] >= 0)) continue;
    const double t = distance[k] / (distance[k] - distance[l]);
    PlaneSection::End& end = section.ends[found++];
    end.barycentric[k] = 1 - t;
    end.barycentric[l] = t;
    end.position = plane.project(corners[k] + t * (corners[l] - corners[k]));
  }
  return found == 2 ? std::optional(section) : std::nullopt;
}

/// Clips the range [begin, end] of the line from a to b to a half-plane. @return false if nothing
/// is left.
bool clip(const BladePlane::HalfPlane& half_plane, const Vec2d& a, const Vec2d& b, double& begin,
          double& end) {
  const double at_a = half_plane.value(a), at_b = half_plane.value(b);
  if (at_a < 0 && at_b < 0) return false;
  if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
  if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
  return begin <= end;
}

/// The contact of a sweep with one triangle.
struct Contact {
  SurfaceHit hit;
  SweepCoordinates low;  ///< Coordinates of the hit.
};

std::optional<Contact> contact_with(Index triangle, const FaceCorners& corners,
                                    const BladePlane& plane, double progress,
                                    const BladePlane::HalfPlane& not_before) {
  const auto section = cross_triangle(plane, corners);
  if (!section) return std::nullopt;
  const Vec2d &a = section->ends[0].position, &b = section->ends[1].position;
  double begin = 0, end = 1;
  bool is_reached = clip(not_before, a, b, begin, end);
  for (const auto& half_plane : plane.reach())
    is_reached = is_reached && clip(half_plane, a, b, begin, end);
  if (!is_reached || end - begin < kSnapEdges)
    return std::nullopt;  // a remnant of a triangle whose neighbour's end was snapped

  const SweepCoordinates at_begin = plane.sweep_coordinates(a + begin * (b - a));
  const SweepCoordinates at_end = plane.sweep_coordinates(a + end * (b - a));
  const bool forward = at_begin.progress <= at_end.progress;
  const SweepCoordinates& low = forward ? at_begin : at_end;
  const SweepCoordinates& high = forward ? at_end : at_begin;
  if (!(high.progress > std::max(low.progress, progress) + kSamePlaceSweeps)) return std::nullopt;
  const double at = forward ? begin : end;
  Contact contact{{triangle, {}, Vec3d::Zero(), high.progress}, low};
  for (std::size_t k = 0; k < 3; ++k) {
    contact.hit.barycentric[k] =
        (1 - at) * section->ends[0].barycentric[k] + at * section->ends[1].barycentric[k];
    contact.hit.position += contact.hit.barycentric[k] * corners[k];
  }
  return contact;
}

/// Lower bounds of the progress at which a sweep meets the contents of boxes.
class Sweep {
 public:
  /// @param frame  its axes: along the blade, across it, and the plane's normal.
  Sweep(const BladePlane& plane, const BladePlane::HalfPlane& not_before, const Frame& frame)
      : plane_(plane),
        origin_in_frame_(frame.place_of(plane.origin())),
        within_{FramedPlaneSide(frame, plane.left_of(0)),
                FramedPlaneSide(frame, plane.right_of(0)),
                FramedPlaneSide(frame, plane.standing_on(plane.reach()[0])),
                FramedPlaneSide(frame, plane.standing_on(plane.reach()[1])),
                FramedPlaneSide(frame, plane.standing_on(plane.reach()[2])),
                FramedPlaneSide(frame, plane.standing_on(not_before))},
        reach_(std::max(frame.reach(), plane.origin().cwiseAbs().maxCoeff())) {}

  [[nodiscard]] double least_progress(const FrameBox& box) const {
    if (std::any_of(within_.begin(), within_.end(),
                    [&](const FramedPlaneSide& side) { return side.is_beside(box); }))
      return std::numeric_limits<double>::infinity();
    const FrameBox wide = box.widened(reach_);
    return plane_.least_progress({wide.low - origin_in_frame_, wide.high - origin_in_frame_});
  }
  /// The same for the contents of both a box and a shadow.
  [[nodiscard]] double least_progress(const FrameBox& box, const Shadow& shadow) const {
    // In the plane, a pair of parallel lines bounds an interval across the blade.
    const double margin = box.margin(reach_), at_plane = origin_in_frame_.z();
    FrameBox narrow = box;
    narrow.low[0] = std::max(narrow.low[0], shadow.low);
    narrow.high[0] = std::min(narrow.high[0], shadow.high);
    for (std::size_t k = 0; k < 3; ++k) {
      const double steepness = shadow.normal[k].x();
      if (!(std::abs(steepness) > kSteepSine)) continue;
      const double from = (shadow.from[k] - margin - shadow.normal[k].y() * at_plane) / steepness;
      const double to = (shadow.to[k] + margin - shadow.normal[k].y() * at_plane) / steepness;
      narrow.low[1] = std::max(narrow.low[1], std::min(from, to) - margin / std::abs(steepness));
      narrow.high[1] = std::min(narrow.high[1], std::max(from, to) + margin / std::abs(steepness));
    }
    if (narrow.low[1] > narrow.high[1] + margin || narrow.low[0] > narrow.high[0] + margin)
      return std::numeric_limits<double>::infinity();
    return least_progress(narrow);
  }

 private:
  const BladePlane& plane_;
  Vec3d origin_in_frame_;
  std::array<FramedPlaneSide, 6> within_;
  double reach_;
};

/// Calls take(contact) for the contacts of a sweep with the surface. `take` returns the greatest
/// progress that is still of interest.
template <class Take>
void for_each_contact(const BladePlane& plane, double progress, const SurfaceEditor& editor,
                      PosedPoints& posed, ContactWith with, Take take) {
  const BladePlane::HalfPlane not_before = plane.from_progress(progress);
  const Frame frame = posed.frame_along(plane.axes(), editor);
  const Sweep sweep(plane, not_before, frame);
  const auto least_progress = [&](const FrameBox& box, const auto&... shadow) {
    return sweep.least_progress(box, shadow...);
  };
  double limit = std::numeric_limits<double>::max();
  posed.visit_faces(editor, frame, least_progress, [&](Index triangle) {
    if (with == ContactWith::all_but_walls && editor.is_wall(triangle)) return limit;
    const auto contact =
        contact_with(triangle, posed_corners(editor, posed, triangle), plane, progress, not_before);
    if (contact) limit = take(*contact);
    return limit;
  });
}

}  // namespace

std::optional<SurfaceHit> first_hit(const Blade& blade, const SurfaceEditor& editor,
                                    PosedPoints& posed) {
  const Frame frame = posed.frame_along(axes_along(blade.tip - blade.base), editor);
  const BladeSegment segment(blade, frame);
  const auto least_depth = [&](const FrameBox& box, const auto&... shadow) {
    return segment.part_in(box, shadow...).begin_or_infinity();
  };
  NearestHit nearest(segment);
  posed.visit_faces(editor, frame, least_depth, [&](Index triangle) {
    nearest.meet(triangle, posed_corners(editor, posed, triangle));
    return nearest.depth();
  });
  return nearest.hit();
}

std::optional<SurfaceHit> first_contact(const BladePlane& plane, double progress,
                                        const SurfaceEditor& editor, PosedPoints& posed,
                                        ContactWith with) {
  // The choice is independent of the order of visits: the least progress, then the least depth,
  // then the first face.
  double least = std::numeric_limits<double>::max(), least_depth = least;
  std::optional<Contact> nearest;
  const auto is_there = [&](const Contact& contact) {
    return contact.low.progress < least + kSamePlaceSweeps;
  };
  const auto choose = [&](const Contact& contact) {
    if (is_there(contact) && contact.low.depth <= least_depth + kSamePlaceSweeps &&
        (!nearest || contact.hit.triangle < nearest->hit.triangle))
      nearest = contact;
  };
  std::array<Contact, 8> near;
  std::size_t count = 0;
  bool are_all_near_kept = true;
  for_each_contact(plane, progress, editor, posed, with, [&](const Contact& contact) {
    if (contact.low.progress < least) {
      least = contact.low.progress;
      count = static_cast<std::size_t>(
          std::remove_if(near.begin(), near.begin() + count, std::not_fn(is_there)) - near.begin());
    }
    if (is_there(contact)) {
      are_all_near_kept = are_all_near_kept && count < near.size();
      if (are_all_near_kept) near[count++] = contact;
    }
    return least + kSamePlaceSweeps;
  });
  if (are_all_near_kept) {
    for (const Contact& contact : std::span(near).first(count))
      least_depth = std::min(least_depth, contact.low.depth);
    for (const Contact& contact : std::span(near).first(count)) choose(contact);
  } else {  // many faces around one point: two more passes
    for_each_contact(plane, progress, editor, posed, with, [&](const Contact& contact) {
      if (is_there(contact)) least_depth = std::min(least_depth, contact.low.depth);
      return least + kSamePlaceSweeps;
    });
    for_each_contact(plane, progress, editor, posed, with, [&](const Contact& contact) {
      choose(contact);
      return least + kSamePlaceSweeps;
    });
  }
  return nearest ? std::optional(nearest->hit) : std::nullopt;
}

std::optional<SurfaceHit> contact_in(Index triangle, const BladePlane& plane, double progress,
                                     const SurfaceEditor& editor, PosedPoints& posed) {
  const auto contact = contact_with(triangle, posed_corners(editor, posed, triangle), plane,
                                    progress, plane.from_progress(progress));
  return contact ? std::optional(contact->hit) : std::nullopt;
}

std::optional<SurfaceHit> contact_at(const SurfaceHit& hit, const BladePlane& plane,
                                     const SurfaceEditor& editor, PosedPoints& posed) {
  const auto contact = contact_with(hit.triangle, posed_corners(editor, posed, hit.triangle), plane,
                                    0, plane.not_before());
  return contact && contact->low.progress <= kSamePlaceSweeps ? std::optional(contact->hit)
                                                              : std::nullopt;
}

}  // namespace sunder::tear
