#pragma once

#include <sunder/core/character.h>
#include <sunder/plan/plan.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/plan/posed_places.h"
#include "pipeline/plan/timeline.h"

namespace sunder::plan {

/// Where a blade shall be at a time: model space.
struct TargetSample {
  double time = 0;
  double share = 0;              ///< Of the curve's length.
  double lift = 0;               ///< Timeline::lift_at().
  Vec3d place = Vec3d::Zero();   ///< On the curve, posed.
  Vec3d normal = Vec3d::Zero();  ///< Of the surface there, unit length.
  Vec3d handle = Vec3d::Zero();  ///< From tip to base, unit length.
  double depth = 0;              ///< Of the tip below `place` along -normal; below 0: above it.
  double full_depth = 0;  ///< The wanted depth there; less than that near the ends of the curve.
  bool is_full = false;   ///< Whether `depth` is that.
};

/// The direction of a run of places at one of them, within the surface: from a place before to one
/// behind; unit length, or zero.
[[nodiscard]] Vec3d direction_at(const Vec3d& before, const Vec3d& behind, const Vec3d& normal);

/// A TargetPath in a pose.
struct PosedPath {
  std::vector<Vec3d> places, normals;  ///< Of its anchors.
};

/// A WoundTarget as a dense run of places in triangles.
class TargetPath {
 public:
  /// @param character  kept by reference.
  /// @param pose       in which the curve is laid on the surface.
  static Result<TargetPath> create(const std::shared_ptr<const Character>& character,
                                   const WoundTarget& target, const ModelPose& pose);

  [[nodiscard]] double length() const { return along_.back(); }
  [[nodiscard]] const std::vector<SurfaceAnchor>& anchors() const { return anchors_; }

  [[nodiscard]] bool is_closed() const { return is_closed_; }

  /// The length from the begin to each anchor, as a share of all.
  [[nodiscard]] const std::vector<double>& shares() const { return shares_; }

  [[nodiscard]] double widest_gape() const { return widest_gape_; }  ///< Metres; 0: not wanted.
  /// Whether a gape is wanted all along, not only where it is widest.
  [[nodiscard]] bool has_gape_profile() const { return has_gape_profile_; }
  /// The gape that is wanted at a share of the curve, metres.
  [[nodiscard]] double gape_at(double share) const;

  /// Moves what samples aim at, besides what was moved before: metres along the curve and, across
  /// it, towards normal x direction, one per anchor. Anchors and length stay as they are.
  void aim_beside(std::span<const Vec2d> offsets);

  /// @param posed  written.
  Status pose(const ModelPose& pose, PosedPath& posed) const;
  /// Where the blade shall be at `sample.share` and `sample.lift`; its time stays as it is.
  void sample(const PosedPath& posed, double standoff, TargetSample& sample) const;

 private:
  TargetPath() = default;

  std::shared_ptr<const Character> character_;
  std::vector<SurfaceAnchor> anchors_;
  std::vector<double> along_;                 ///< Length from the begin to each anchor, metres.
  std::vector<double> depth_, angle_, gape_;  ///< At each anchor.
  std::vector<double> shares_;
  double widest_gape_ = 0;
  bool has_gape_profile_ = false;
  std::vector<Vec2d> beside_;  ///< Offsets of the aim; empty: none.
  bool is_closed_ = false;
  std::optional<PosedPlaces> places_;  ///< The anchors.
};

/// The samples of a motion at times of the timeline.
Result<std::vector<TargetSample>> sample_target(const Character& character, const TargetPath& path,
                                                const PlanTiming& timing,
                                                std::span<const double> times);

/// The samples of a motion at even times, `count` + 1 of them from 0 to the end of the timeline.
Result<std::vector<TargetSample>> sample_target(const Character& character, const TargetPath& path,
                                                const PlanTiming& timing, std::uint32_t count);

/// The pose of the character at a time of the motion.
Result<ModelPose> pose_at(const Character& character, const PlanTiming& timing, double time);

}  // namespace sunder::plan
