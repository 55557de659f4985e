#include "tear/entry.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace sunder::tear {
namespace {

using Corners = std::array<Vec3d, 3>;

Corners posed_corners(const SurfaceEditor& editor, PosedPoints& posed, Index triangle) {
  const Index* points = &editor.surface().corner_point[3 * triangle];
  return {posed.position(editor, points[0]), posed.position(editor, points[1]), posed.position(editor, points[2])};
}

/// The part of a triangle that lies in the plane, as two points on its edges.
struct Crossing {
  struct End {
    std::array<double, 3> barycentric = {0, 0, 0};
    Vec2d position = Vec2d::Zero();  ///< In the plane.
  };
  std::array<End, 2> ends;
};

std::optional<Crossing> cross_triangle(const BladePlane& plane, const Corners& corners) {
  std::array<double, 3> distance;
  for (std::size_t k = 0; k < 3; ++k) distance[k] = plane.distance(corners[k]);
  Crossing crossing;
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3;
    if ((distance[k] >= 0) == (distance[l] >= 0)) continue;
    const double t = distance[k] / (distance[k] - distance[l]);
    Crossing::End& end = crossing.ends[found++];
    end.barycentric[k] = 1 - t;
    end.barycentric[l] = t;
    end.position = plane.project(corners[k] + t * (corners[l] - corners[k]));
  }
  return found == 2 ? std::optional(crossing) : std::nullopt;
}

/// Cuts [begin, end] of the line from a to b to a half-plane; false where nothing is left.
bool clip(const BladePlane::HalfPlane& half_plane, const Vec2d& a, const Vec2d& b, double& begin, double& end) {
  const double at_a = half_plane.value(a), at_b = half_plane.value(b);
  if (at_a < 0 && at_b < 0) return false;
  if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
  if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
  return begin <= end;
}

/// A segment, and where it runs within boxes.
class Segment {
 public:
  explicit Segment(const Blade& blade)
      : base_(blade.base),
        direction_(blade.tip - blade.base),
        axes_(axes_along(direction_)),
        base_in_axes_(axes_ * base_),
        direction_in_axes_(axes_ * direction_),
        reach_(std::max(base_.cwiseAbs().maxCoeff(), blade.tip.cwiseAbs().maxCoeff())) {}

  /// Those that boxes are in: the first is the segment's direction.
  [[nodiscard]] const Mat3d& axes() const { return axes_; }

  struct Part {
    double begin = 0, end = 1;
    [[nodiscard]] bool is_empty() const { return begin > end; }
    [[nodiscard]] double begin_or_infinity() const { return is_empty() ? std::numeric_limits<double>::infinity() : begin; }
  };
  /// The part within a box, on the safe side of rounding. The part within a box inside it lies in that part, to the last bit.
  [[nodiscard]] Part part_in(const Box& box) const {
    const Box wide = box.widened(reach_);
    Part part;
    for (int k = 0; k < 3; ++k) {
      const double to_low = wide.low[k] - base_in_axes_[k], to_high = wide.high[k] - base_in_axes_[k];
      if (direction_in_axes_[k] == 0) {
        if (to_low > 0 || to_high < 0) return {1, 0};
        continue;
      }
      const bool ascends = direction_in_axes_[k] > 0;
      part.begin = std::max(part.begin, (ascends ? to_low : to_high) / direction_in_axes_[k]);
      part.end = std::min(part.end, (ascends ? to_high : to_low) / direction_in_axes_[k]);
    }
    return part;
  }

  /// Of what lies both in a box and in a shadow.
  [[nodiscard]] Part part_in(const Box& box, const Shadow& shadow) const {
    const double margin = box.margin(reach_);
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = shadow.normal[k].x() * base_in_axes_.y() + shadow.normal[k].y() * base_in_axes_.z();
      if (at < shadow.from[k] - margin || at > shadow.to[k] + margin) return {1, 0};
    }
    const double to_low = shadow.low - margin - base_in_axes_.x(), to_high = shadow.high + margin - base_in_axes_.x();
    return {std::max(0.0, to_low / direction_in_axes_.x()), std::min(1.0, to_high / direction_in_axes_.x())};
  }

  /// Where it meets a triangle, edges included so that none slips between two faces: Moeller and Trumbore 1997.
  [[nodiscard]] std::optional<SurfaceHit> hit(Index triangle, const Corners& corners, double& depth) const {
    const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Vec3d h = direction_.cross(ac);
    const double determinant = ab.dot(h);
    if (!(std::abs(determinant) > 1e-14 * ab.norm() * ac.norm() * direction_.norm())) return std::nullopt;
    const Vec3d from_corner = base_ - corners[0];
    const double u = from_corner.dot(h) / determinant;
    const Vec3d q = from_corner.cross(ab);
    const double v = direction_.dot(q) / determinant;
    depth = ac.dot(q) / determinant;
    constexpr double kEdge = 1e-12;
    if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge || depth < 0 || depth > 1) return std::nullopt;
    // Along a triangle's plane, rounding finds places that are not in the triangle.
    const Vec3d a = axes_ * corners[0], b = axes_ * corners[1], c = axes_ * corners[2];
    const Part part = part_in({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
    if (part.is_empty()) return std::nullopt;
    depth = std::clamp(depth, part.begin, part.end);
    return SurfaceHit{triangle, {std::max(0.0, 1 - u - v), std::max(0.0, u), std::max(0.0, v)}, base_ + depth * direction_, 0};
  }

 private:
  Vec3d base_, direction_;
  Mat3d axes_;
  Vec3d base_in_axes_, direction_in_axes_;
  double reach_;
};

/// Where a sweep meets one triangle.
struct Contact {
  SurfaceHit hit;
  SweepCoordinates low;  ///< Of the hit.
};

std::optional<Contact> contact_with(Index triangle, const Corners& corners, const BladePlane& plane, double progress,
                                    const BladePlane::HalfPlane& not_before) {
  const auto crossing = cross_triangle(plane, corners);
  if (!crossing) return std::nullopt;
  const Vec2d &a = crossing->ends[0].position, &b = crossing->ends[1].position;
  double begin = 0, end = 1;
  bool is_reached = clip(not_before, a, b, begin, end);
  for (const auto& half_plane : plane.reach()) is_reached = is_reached && clip(half_plane, a, b, begin, end);
  if (!is_reached || end - begin < kSnap) return std::nullopt;  // what is left of a triangle after its neighbour's end was snapped

  const SweepCoordinates at_begin = plane.sweep_coordinates(a + begin * (b - a));
  const SweepCoordinates at_end = plane.sweep_coordinates(a + end * (b - a));
  const bool forward = at_begin.progress <= at_end.progress;
  const SweepCoordinates& low = forward ? at_begin : at_end;
  const SweepCoordinates& high = forward ? at_end : at_begin;
  if (!(high.progress > std::max(low.progress, progress) + kSamePlace)) return std::nullopt;
  const double at = forward ? begin : end;
  Contact contact{{triangle, {}, Vec3d::Zero(), high.progress}, low};
  for (std::size_t k = 0; k < 3; ++k) {
    contact.hit.barycentric[k] = (1 - at) * crossing->ends[0].barycentric[k] + at * crossing->ends[1].barycentric[k];
    contact.hit.position += contact.hit.barycentric[k] * corners[k];
  }
  return contact;
}

/// Where a sweep may meet what lies in boxes.
class Sweep {
 public:
  Sweep(const BladePlane& plane, const BladePlane::HalfPlane& not_before)
      : plane_(plane),
        axes_(plane.axes()),
        within_{in_axes(axes_, plane.left_of(0)),
                in_axes(axes_, plane.right_of(0)),
                in_axes(axes_, plane.standing_on(plane.reach()[0])),
                in_axes(axes_, plane.standing_on(plane.reach()[1])),
                in_axes(axes_, plane.standing_on(plane.reach()[2])),
                in_axes(axes_, plane.standing_on(not_before))} {
    for (const HalfSpace& side : within_) reach_ = std::max(reach_, std::abs(side.offset));
  }

  /// Those that boxes are in: along the blade, across it, and the plane's normal.
  [[nodiscard]] const Mat3d& axes() const { return axes_; }
  [[nodiscard]] double least_progress(const Box& box) const {
    return std::any_of(within_.begin(), within_.end(), [&](const HalfSpace& side) { return is_outside(side, box); })
               ? std::numeric_limits<double>::infinity()
               : plane_.least_progress(box.widened(reach_));
  }
  /// Of what lies both in a box and in a shadow.
  [[nodiscard]] double least_progress(const Box& box, const Shadow& shadow) const {
    // In the plane, a pair of parallels leaves an interval across the blade.
    const double margin = box.margin(reach_), at_plane = within_[0].offset;
    Box narrow = box;
    narrow.low[0] = std::max(narrow.low[0], shadow.low);
    narrow.high[0] = std::min(narrow.high[0], shadow.high);
    for (std::size_t k = 0; k < 3; ++k) {
      const double steepness = shadow.normal[k].x();
      if (!(std::abs(steepness) > 1e-6)) continue;
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
  Mat3d axes_;
  std::array<HalfSpace, 6> within_;
  double reach_ = 0;
};

/// Calls take(contact) for the contacts of a sweep with the surface. It returns the greatest progress that is of interest from then
/// on.
template <class Take>
void for_each_contact(const BladePlane& plane, double progress, const SurfaceEditor& editor, PosedPoints& posed, Take take) {
  const BladePlane::HalfPlane not_before = plane.from_progress(progress);
  const Sweep sweep(plane, not_before);
  const auto least_progress = [&](const Box& box, const auto&... shadow) { return sweep.least_progress(box, shadow...); };
  double limit = std::numeric_limits<double>::max();
  posed.visit_faces(editor, sweep.axes(), least_progress, [&](Index triangle) {
    const auto contact = contact_with(triangle, posed_corners(editor, posed, triangle), plane, progress, not_before);
    if (contact) limit = take(*contact);
    return limit;
  });
}

}  // namespace

std::optional<SurfaceHit> first_hit(const Blade& blade, const SurfaceEditor& editor, PosedPoints& posed) {
  const Segment segment(blade);
  std::optional<SurfaceHit> nearest;
  double nearest_depth = 1.0;
  const auto least_depth = [&](const Box& box, const auto&... shadow) {
    return segment.part_in(box, shadow...).begin_or_infinity();
  };
  posed.visit_faces(editor, segment.axes(), least_depth, [&](Index triangle) {
    double depth = 0;
    const auto hit = segment.hit(triangle, posed_corners(editor, posed, triangle), depth);
    const bool is_nearer = hit && (depth < nearest_depth || (depth == nearest_depth && (!nearest || triangle < nearest->triangle)));
    if (is_nearer) {
      nearest_depth = depth;
      nearest = hit;
    }
    return nearest_depth;
  });
  return nearest;
}

std::optional<SurfaceHit> first_contact(const BladePlane& plane, double progress, const SurfaceEditor& editor, PosedPoints& posed) {
  // Whatever the order of visits: the least progress, there the least depth, there the first face.
  double least = std::numeric_limits<double>::max(), least_depth = least;
  std::optional<Contact> nearest;
  const auto is_there = [&](const Contact& contact) { return contact.low.progress < least + kSamePlace; };
  const auto choose = [&](const Contact& contact) {
    if (is_there(contact) && contact.low.depth <= least_depth + kSamePlace &&
        (!nearest || contact.hit.triangle < nearest->hit.triangle))
      nearest = contact;
  };
  std::array<Contact, 8> near;
  std::size_t count = 0;
  bool are_all_near_kept = true;
  for_each_contact(plane, progress, editor, posed, [&](const Contact& contact) {
    if (contact.low.progress < least) {
      least = contact.low.progress;
      count = static_cast<std::size_t>(std::remove_if(near.begin(), near.begin() + count, std::not_fn(is_there)) - near.begin());
    }
    if (is_there(contact)) {
      are_all_near_kept = are_all_near_kept && count < near.size();
      if (are_all_near_kept) near[count++] = contact;
    }
    return least + kSamePlace;
  });
  if (are_all_near_kept) {
    for (const Contact& contact : std::span(near).first(count)) least_depth = std::min(least_depth, contact.low.depth);
    for (const Contact& contact : std::span(near).first(count)) choose(contact);
  } else {  // many faces around one point: look once more, and again
    for_each_contact(plane, progress, editor, posed, [&](const Contact& contact) {
      if (is_there(contact)) least_depth = std::min(least_depth, contact.low.depth);
      return least + kSamePlace;
    });
    for_each_contact(plane, progress, editor, posed, [&](const Contact& contact) {
      choose(contact);
      return least + kSamePlace;
    });
  }
  return nearest ? std::optional(nearest->hit) : std::nullopt;
}

}  // namespace sunder::tear
