#pragma once

#include <sunder/operation/weight_options.h>

#include <map>

#include "bench/weights_scene.h"
#include "weights/internal/point_refit.h"

namespace sunder::bench {

/// The points of all tears of a model, ready to be weighed over some poses by the functions of
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
  /// A point with its barycentric influences, cut to a number of the largest; 0: all. Valid as long
  /// as
  /// this object.
  [[nodiscard]] PointToRefit to_refit(std::size_t i, std::size_t maximum) const;

  /// Microseconds a point: the least of many runs over all of them. In each, corners, matrices and
  /// moments are there; what a policy makes of them is made: the mean influences, pruned; for the
  /// others the point's exact description too; and from it the bind position that meets the first
  /// pose, or the fit.
  [[nodiscard]] double microseconds(const WeightOptions& options) const;
  /// Times of the fits alone, for those points, over existing descriptions.
  [[nodiscard]] double fit_microseconds(const PointRefit::Options& options,
                                        std::span<const std::size_t> points) const;

 private:
  struct Point {
    const TornPoint* torn;
    std::uint32_t skin;
    std::vector<Influence> barycentric;  ///< Largest first.
    std::vector<Influence> pruned;       ///< The four largest, with sum one.
    std::vector<Influence> pruned_to_8;
  };
  std::vector<Point> points_;
  std::map<std::uint32_t, PoseMoments> moments_;  ///< By skin.
  std::map<std::uint32_t, std::vector<std::vector<Affine3d>>>
      palettes_;  ///< Per skin, one per pose.
};

/// So many of the poses, evenly spread.
[[nodiscard]] std::vector<ModelPose> some_of(std::span<const ModelPose> poses, std::size_t count);

}  // namespace sunder::bench
