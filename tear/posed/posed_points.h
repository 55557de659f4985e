#pragma once

#include <sunder/core/skeleton.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tear/posed/patch_forest.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Positions of surface points in one pose, in double, computed when first asked for. Points that
/// the operation under way makes are pinned to where it found them on the posed surface, so that
/// one stroke is torn on one surface; later operations see them where their weights put them.
class PosedPoints {
 public:
  /// @return size_mismatch or non_finite_value where the pose does not fit the character.
  [[nodiscard]] static Status check(const Character& character, const ModelPose& pose);
  /// check(), then forgets all points.
  [[nodiscard]] Status begin(const Character& character, const ModelPose& pose);

  /// The reference is good until the surface has more points than were covered.
  [[nodiscard]] const Vec3d& position(const SurfaceEditor& editor, Index point) {
    if (point < known_.size() && known_[point].since == epoch_) return known_[point].position;
    return look_up(editor, point);
  }

  /// Where a point was posed or pinned in this pose; null where it was not.
  [[nodiscard]] const Vec3d* find_known(Index point) const {
    return point < known_.size() && known_[point].since == epoch_ ? &known_[point].position
                                                                  : nullptr;
  }

  /// Asks memory for what posing a point will need.
  void fetch(const SurfaceEditor& editor, Index point) const;

  void cover(Index point_count) {
    if (known_.size() >= point_count) return;
    if (known_.capacity() < point_count)
      known_.reserve(point_count + point_count / 8 + 1024);  // not twice as much
    known_.resize(point_count);
  }

  /// Keeps a point where it was found on the posed surface, instead of where its own weights put
  /// it.
  void pin(Index point, const Vec3d& position);
  [[nodiscard]] const std::vector<Affine3d>& palette(Index skin) const { return palettes_[skin]; }
  [[nodiscard]] std::span<const std::vector<Affine3d>> palettes() const { return palettes_; }
  [[nodiscard]] const std::vector<float>& morph_weights() const { return morph_weights_; }

  /// Along some axes, from a place near the surface.
  [[nodiscard]] Frame frame_along(const Mat3d& axes, const SurfaceEditor& editor) const;
  /// Visits faces of the surface where `bound` lets it: PatchForest::visit_faces().
  template <class Bound, class Visit>
  void visit_faces(const SurfaceEditor& editor, const Frame& frame, Bound bound, Visit visit) {
    const auto expect = [&](Index mesh, std::span<const Index> origins) {
      fetch(editor, mesh, origins);
    };
    forest_.visit_faces(editor, {palettes_, morph_weights_}, frame, bound, expect, visit);
  }
  /// Calls visit(face) for the live faces of the patches whose boxes may_hold(box) lets through, in
  /// no order that means anything.
  template <class MayHold, class Visit>
  void for_each_face(const SurfaceEditor& editor, const Frame& frame, MayHold may_hold,
                     Visit visit) {
    const auto bound = [&](const Box& box) {
      return may_hold(box) ? 0.0 : std::numeric_limits<double>::infinity();
    };
    visit_faces(editor, frame, bound, [&](Index face) {
      visit(face);
      return 0.0;
    });
  }
  [[nodiscard]] PatchForest& forest() { return forest_; }

  /// How many points have been posed or pinned since begin(). O(all points).
  [[nodiscard]] std::size_t known_count() const {
    return static_cast<std::size_t>(std::count_if(
        known_.begin(), known_.end(), [&](const Known& known) { return known.since == epoch_; }));
  }

  /// Forgets the points from `first_point` up, which were taken back.
  void forget_from(Index first_point);

 private:
  /// Asks memory for what posing some faces will need, for all of them at once: on a large mesh,
  /// waiting for one array after the other, point after point, takes ten times as long as posing
  /// them. @param origins  of a patch.
  void fetch(const SurfaceEditor& editor, Index mesh, std::span<const Index> origins) const;

  std::vector<std::vector<Affine3d>> palettes_;  ///< Of each skin.
  std::vector<float> morph_weights_;
  struct Known {
    Vec3d position = Vec3d::Zero();
    std::uint32_t since = 0;  ///< Epoch in which it was computed or pinned.
  };
  [[nodiscard]] const Vec3d& look_up(const SurfaceEditor& editor, Index point);

  std::vector<Known> known_;
  std::uint32_t epoch_ = 0;  ///< Of the pose: a new one forgets all positions at once.
  PatchForest forest_;
};

}  // namespace sunder::tear
