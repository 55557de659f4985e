#pragma once

#include <sunder/operation/weight_options.h>

#include <map>

#include "bench/weights/weights_scene.h"
#include "weights/internal/point_refit.h"

namespace sunder::bench {

/// The points of all tears of a model, prepared for weighing over some poses by the functions of
/// `weights`.
class PointsToWeigh {
 public:
  PointsToWeigh(const WeightsModel& model, std::span<const ModelPose> poses);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const TornPoint& point(std::size_t i) const { return *points_[i].torn; }
  [[nodiscard]] const PoseMoments& moments(std::size_t i) const {
    return moments_.at(points_[i].skin);
  }
  /// model_from_bind in each of the poses, of the skin that moves a point.
  [[nodiscard]] std::span<const std::vector<Affine3d>> palettes(std::size_t i) const {
    return palettes_.at(points_[i].skin);
  }
  /// A point with its barycentric influences, pruned to the given number; 0: all. Valid as long as
  /// this object.
  [[nodiscard]] PointToRefit to_refit(std::size_t i, std::size_t maximum) const;

  /// Microseconds per point; the minimum of many runs over all points. Corners, matrices and
  /// moments are inputs. Timed are the mean influences, pruned; for policies other than barycentric
  /// also the point's exact description; and from it the bind position that meets the first pose,
  /// or the fit.
  [[nodiscard]] double microseconds(const WeightOptions& options) const;
  /// Times of the fits only, for these points, with existing descriptions.
  [[nodiscard]] double fit_microseconds(const PointRefit::Options& options,
                                        std::span<const std::size_t> points) const;

 private:
  struct Point {
    const TornPoint* torn;
    std::uint32_t skin;
    std::vector<Influence> barycentric;  ///< Largest first.
    std::vector<Influence> pruned;       ///< The four largest weights, normalised.
    std::vector<Influence> pruned_to_8;
  };
  std::vector<Point> points_;
  std::map<std::uint32_t, PoseMoments> moments_;  ///< By skin.
  /// Per skin, one per pose.
  std::map<std::uint32_t, std::vector<std::vector<Affine3d>>> palettes_;
};

/// This number of the poses, evenly spaced.
[[nodiscard]] std::vector<ModelPose> some_of(std::span<const ModelPose> poses, std::size_t count);

}  // namespace sunder::bench
