#pragma once

#include <sunder/core/skeleton.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "skinning/internal/character_pose.h"
#include "tear/geometry/plane_side.h"
#include "tear/posed/patch_forest.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Positions of surface points in one pose, in double, computed on demand. Points created by the
/// current operation are pinned to where it found them on the posed surface, so that one stroke is
/// torn on one surface. Later operations see them where their weights put them.
class PosedPoints {
 public:
  /// A surface of fewer points stays in the cache of a core, where prefetching costs more than it
  /// saves.
  static constexpr Index kCachedPoints = 8192;

  /// Sets the pose and forgets all points. @return as CharacterPose::set().
  [[nodiscard]] Status begin(const Character& character, const ModelPose& pose);

  /// Whether begin() has succeeded.
  [[nodiscard]] bool has_pose() const { return epoch_ != 0; }

  /// The reference stays valid until the surface has more points than were covered.
  [[nodiscard]] const Vec3d& position(const SurfaceEditor& editor, Index point) {
    if (point < known_.size() && known_[point].since == epoch_) return known_[point].position;
    return look_up(editor, point);
  }

  /// The position of a point that was posed or pinned since begin(); otherwise null.
  [[nodiscard]] const Vec3d* find_known(Index point) const {
    return point < known_.size() && known_[point].since == epoch_ ? &known_[point].position
                                                                  : nullptr;
  }

  /// Sets the plane of is_inside().
  void compare_with(const PlaneSide& plane);
  /// Whether a point is inside the half-space set last. Computed once per point.
  [[nodiscard]] bool is_inside(const SurfaceEditor& editor, Index point) {
    if (point < known_.size() && known_[point].since == epoch_ &&
        known_[point].compared >> 2 == plane_number_)
      return (known_[point].compared & kInside) != 0;
    return (find_side(editor, point) & kInside) != 0;
  }
  /// Whether a point lies on the plane set last, within the rounding of its stored position.
  [[nodiscard]] bool is_on_plane(const SurfaceEditor& editor, Index point) {
    if (point < known_.size() && known_[point].since == epoch_ &&
        known_[point].compared >> 2 == plane_number_)
      return (known_[point].compared & kOnPlane) != 0;
    return (find_side(editor, point) & kOnPlane) != 0;
  }
  /// No point farther from the plane set last than this is on it.
  [[nodiscard]] double farthest_on_plane(const SurfaceEditor& editor) {
    if (bound_of_ != std::array{epoch_, plane_number_}) bound_stored_rounding(editor);
    return farthest_on_plane_;
  }
  /// Whether a point was pinned since begin().
  [[nodiscard]] bool has_pins() const { return has_pins_; }

  /// Prefetches the memory that is read to pose a point.
  void fetch(const SurfaceEditor& editor, Index point) const;

  /// Makes room for `point_count` points.
  void cover(Index point_count) {
    if (known_.size() >= point_count) return;
    if (known_.capacity() < point_count)
      known_.reserve(point_count + point_count / 8 + 1024);  // not twice as much
    known_.resize(point_count);
  }

  /// Fixes a point where it was found on the posed surface, instead of where its own weights put
  /// it.
  void pin(Index point, const Vec3d& position);
  [[nodiscard]] const CharacterPose& pose() const { return pose_; }

  /// A frame with the given axes and its origin near the surface.
  [[nodiscard]] Frame frame_along(const Mat3d& axes, const SurfaceEditor& editor) const;
  /// Visits faces of the surface as `bound` directs; see PatchForest::visit_faces().
  template <class Bound, class Visit>
  void visit_faces(const SurfaceEditor& editor, const Frame& frame, Bound bound, Visit visit,
                   NewFillings fillings = NewFillings::in_trees) {
    const auto expect = [&](Index mesh, std::span<const Index> origins) {
      fetch(editor, mesh, origins);
    };
    forest_.visit_faces(editor, pose_, frame, bound, expect, visit, fillings);
  }
  /// Calls visit(face) for the live faces of all patches whose boxes may_hold(box) accepts, in no
  /// particular order.
  template <class MayHold, class Visit>
  void for_each_face(const SurfaceEditor& editor, const Frame& frame, MayHold may_hold, Visit visit,
                     NewFillings fillings = NewFillings::in_trees) {
    const auto bound = [&](const FrameBox& box) {
      return may_hold(box) ? 0.0 : std::numeric_limits<double>::infinity();
    };
    const auto visit_any = [&](Index face) {
      visit(face);
      return 0.0;
    };
    visit_faces(editor, frame, bound, visit_any, fillings);
  }
  [[nodiscard]] PatchForest& forest() { return forest_; }

  /// Memory of the points and the trees.
  [[nodiscard]] std::size_t bytes() const {
    return known_.capacity() * sizeof(Known) + forest_.bytes();
  }
  /// Number of points posed or pinned since begin(). O(all points).
  [[nodiscard]] std::size_t known_count() const {
    return static_cast<std::size_t>(std::count_if(
        known_.begin(), known_.end(), [&](const Known& known) { return known.since == epoch_; }));
  }

  /// Forgets the points from `first_point` on, which were undone.
  void forget_from(Index first_point);

 private:
  /// Prefetches the memory that is read to pose some faces, for all of them at once: on a large
  /// mesh, waiting for one array after the other, point by point, takes ten times as long as posing
  /// them. @param origins  of a patch.
  void fetch(const SurfaceEditor& editor, Index mesh, std::span<const Index> origins) const;

  struct Known {
    Vec3d position = Vec3d::Zero();
    std::uint32_t since = 0;     ///< Epoch in which it was computed or pinned.
    std::uint32_t compared = 0;  ///< Four times the number of a plane, and the bits below.
  };
  static constexpr std::uint32_t kInside = 1, kOnPlane = 2;
  [[nodiscard]] const Vec3d& look_up(const SurfaceEditor& editor, Index point);
  /// @return the bits of Known::compared.
  [[nodiscard]] std::uint32_t find_side(const SurfaceEditor& editor, Index point);
  /// How far the rounding of stored positions moves a point across the plane set last.
  [[nodiscard]] double stored_rounding(const SurfaceEditor& editor, Index point) const;
  void bound_stored_rounding(const SurfaceEditor& editor);

  CharacterPose pose_;
  std::vector<Known> known_;
  std::uint32_t epoch_ = 0;  ///< Epoch of the pose: a new epoch invalidates all positions at once.
  PlaneSide plane_;          ///< Of is_inside().
  std::uint32_t plane_number_ = 1;  ///< Below 2^30.
  double farthest_on_plane_ = 0;
  std::array<std::uint32_t, 2> bound_of_ = {};  ///< The epoch and plane_number_ of that.
  bool has_pins_ = false;
  PatchForest forest_;
};

}  // namespace sunder::tear
