#pragma once

#include <sunder/core/skin.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tear/weights/refit_task.h"

namespace sunder::bench {

/// The weights and bind position of one point.
struct PointSkin {
  std::vector<Influence> influences;
  Vec3d position = Vec3d::Zero();
};

/// Poses with a weight each, and where bones and points are in them.
struct PosedPoints {
  struct Pose {
    std::vector<std::vector<Affine3d>> palettes;  ///< One per skin.
    double weight = 1;
    std::vector<Vec3d> exact;  ///< One per point: where it belongs.
  };
  std::vector<Pose> poses;
};

/// The points of a refit and the poses to fit them over.
struct PointsToFit {
  std::span<const tear::RefitTask::Point> points;
  std::span<const PointSkin> barycentric;  ///< Of at most `most` influences.
  std::span<const RefitNeighbours> neighbours;
  const PosedPoints& poses;
  std::size_t most = 4;  ///< Influences per point.
};

/// Positions and weights in turn, each a least squares problem, over all bones of the point; then
/// bones are dropped and the turns go on over the rest. No bounds and no regularisation.
enum class Reduction {
  /// The bones with the largest effect are kept at once: Le, Deng, Smooth skinning decomposition
  /// with rigid bones, 2012. Bones are not moved, because the rig is given.
  by_effect,
  /// The smallest weight is dropped, the others are solved again, and so on: Landreneau, Schaefer,
  /// Simplification of articulated meshes, 2009.
  smallest_first,
};
[[nodiscard]] std::vector<PointSkin> fit_in_turns(const PointsToFit& points, Reduction reduction);

/// Weights alone: the differences between the errors of neighbours are minimised, in sweeps over
/// the points, and the smallest weights are dropped as above. After Landreneau, Schaefer,
/// Poisson-based weight reduction of animated meshes, 2010.
[[nodiscard]] std::vector<PointSkin> fit_differences(const PointsToFit& points);

/// The mean squared distance of a point from where it belongs, over all poses.
[[nodiscard]] double mean_square(const PosedPoints& poses, std::size_t point, std::uint32_t skin,
                                 const PointSkin& fit);

}  // namespace sunder::bench
