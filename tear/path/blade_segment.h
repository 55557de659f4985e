#pragma once

#include <sunder/operation/operation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/geometry/box.h"
#include "tear/geometry/tolerances.h"
#include "tear/path/surface_hit.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Posed.
using FaceCorners = std::array<Vec3d, 3>;

inline FaceCorners posed_corners(const SurfaceEditor& editor, PosedPoints& posed, Index triangle) {
  const Index* points = &editor.surface().corner_point[3 * triangle];
  return {posed.position(editor, points[0]), posed.position(editor, points[1]),
          posed.position(editor, points[2])};
}

/// Where a segment crosses the plane of a triangle.
struct FaceCrossing {
  double u, v;   ///< Barycentric coordinates of the second and the third corner.
  double depth;  ///< As a fraction of the segment.
};

/// The crossing of a segment with a triangle or its edges. Moeller and Trumbore 1997.
[[nodiscard]] inline std::optional<FaceCrossing> cross_face(const Vec3d& base,
                                                            const Vec3d& direction,
                                                            const FaceCorners& corners) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vec3d h = direction.cross(ac);
  const double determinant = dot(ab, h);
  const Vec3d from_corner = base - corners[0];
  // Most faces are missed beside their first edges; numbers that are not finite are found below.
  const double u = dot(from_corner, h) / determinant;
  if (u < -kHitBarycentric || u > 1 + 4 * kHitBarycentric) return std::nullopt;
  const Vec3d q = from_corner.cross(ab);
  const double v = dot(direction, q) / determinant;
  if (v < -kHitBarycentric || u + v > 1 + kHitBarycentric) return std::nullopt;
  const double depth = dot(ac, q) / determinant;
  if (depth < 0 || depth > 1) return std::nullopt;
  if (!(std::abs(determinant) > kAlongFaceLengths * norm(ab) * norm(ac) * norm(direction)))
    return std::nullopt;
  return FaceCrossing{u, v, depth};
}

/// A segment in a frame whose first axis is its direction. Clips the segment to boxes of that
/// frame.
class BladeSegment {
 public:
  BladeSegment(const Blade& blade, const Frame& frame)
      : base_(blade.base),
        direction_(blade.tip - blade.base),
        frame_(frame),
        base_in_frame_(frame.place_of(base_)),
        direction_in_frame_(multiply(frame.axes, direction_)),
        per_step_(direction_in_frame_.cwiseInverse()),
        reach_(std::max(
            {frame.reach(), base_.cwiseAbs().maxCoeff(), blade.tip.cwiseAbs().maxCoeff()})),
        rounding_(kPosedCoordinates * reach_) {}

  struct Part {
    double begin = 0, end = 1;
    [[nodiscard]] bool is_empty() const { return begin > end; }
    [[nodiscard]] double begin_or_infinity() const {
      return is_empty() ? std::numeric_limits<double>::infinity() : begin;
    }
  };
  /// The part of the segment inside a box of the surface, conservative under rounding. The boxes
  /// already include a margin for rounding in the frame, so only the rounding of model coordinates
  /// is added here.
  [[nodiscard]] Part part_in(const FrameBox& box) const { return part_in(box, rounding_); }

  /// The part inside a shadow. Its box was tested before.
  [[nodiscard]] Part part_in(const FrameBox&, const Shadow& shadow) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double at =
          shadow.normal[k].x() * base_in_frame_.y() + shadow.normal[k].y() * base_in_frame_.z();
      if (at < shadow.from[k] - rounding_ || at > shadow.to[k] + rounding_) return {1, 0};
    }
    const double to_low = shadow.low - rounding_ - base_in_frame_.x(),
                 to_high = shadow.high + rounding_ - base_in_frame_.x();
    return {std::max(0.0, to_low * per_step_.x()), std::min(1.0, to_high * per_step_.x())};
  }

  /// The intersection with a triangle, including its edges so that the segment cannot pass between
  /// two faces.
  [[nodiscard]] inline std::optional<SurfaceHit> hit(Index triangle, const FaceCorners& corners,
                                                     double& depth) const {
    const auto crossing = cross_face(base_, direction_, corners);
    if (!crossing) return std::nullopt;
    // If the segment runs along the triangle's plane, rounding may give places outside the
    // triangle.
    const Vec3d a = frame_.place_of(corners[0]), b = frame_.place_of(corners[1]),
                c = frame_.place_of(corners[2]);
    const FrameBox box{a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
    const Part part = part_in(box, box.margin(reach_));
    if (part.is_empty()) return std::nullopt;
    depth = std::clamp(crossing->depth, part.begin, part.end);
    const auto [u, v, at] = *crossing;
    return SurfaceHit{triangle,
                      {std::max(0.0, 1 - u - v), std::max(0.0, u), std::max(0.0, v)},
                      base_ + depth * direction_,
                      0};
  }

 private:
  Vec3d base_, direction_;
  Frame frame_;
  Vec3d base_in_frame_, direction_in_frame_, per_step_;
  double reach_, rounding_;

  [[nodiscard]] Part part_in(const FrameBox& box, double margin) const {
    Part part;
    for (int k = 0; k < 3; ++k) {
      const double to_low = box.low[k] - margin - base_in_frame_[k],
                   to_high = box.high[k] + margin - base_in_frame_[k];
      if (direction_in_frame_[k] == 0) {
        if (to_low > 0 || to_high < 0) return {1, 0};
        continue;
      }
      const bool ascends = direction_in_frame_[k] > 0;
      part.begin = std::max(part.begin, (ascends ? to_low : to_high) * per_step_[k]);
      part.end = std::min(part.end, (ascends ? to_high : to_low) * per_step_[k]);
    }
    return part;
  }
};

/// The first hit of a segment in the faces that it was compared with, in any order.
class NearestHit {
 public:
  explicit NearestHit(const BladeSegment& segment) : segment_(segment) {}

  void meet(Index triangle, const FaceCorners& corners) {
    double depth = 0;
    const auto hit = segment_.hit(triangle, corners, depth);
    if (!hit || !(depth <= depth_) || (depth == depth_ && triangle >= hit_.triangle)) return;
    depth_ = depth;
    hit_ = *hit;
  }
  /// As a fraction of the segment; 1 if there is none yet.
  [[nodiscard]] double depth() const { return depth_; }
  [[nodiscard]] std::optional<SurfaceHit> hit() const {
    return hit_.triangle != kNone ? std::optional(hit_) : std::nullopt;
  }

 private:
  const BladeSegment& segment_;
  SurfaceHit hit_;  ///< Triangle kNone: none.
  double depth_ = 1.0;
};

}  // namespace sunder::tear
