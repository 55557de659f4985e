#pragma once

#include <span>
#include <vector>

#include "weights/certificate/joint_path.h"

namespace sunder::certificate {

/// Certified bounds of single points, without allocation but for weights that cross slides without
/// a range. Not shared between threads.
class PointBound {
 public:
  /// @param most_terms     that a point may have.
  /// @param sum_tolerance  weight that may cross a slide without a range, see crossed().
  PointBound(const JointTree::State& tree, std::size_t most_terms, double sum_tolerance);

  /// The least of kLanes bounds, with safety for rounding; infinity if there is a gap.
  [[nodiscard]] double of(std::span<const SkinTerm> terms);
  /// Weights of the last point, if it has a bound, that crossed slides without a range and are not
  /// in the bound. Their points are not set.
  [[nodiscard]] std::span<const SlideResidual> crossed() const { return crossed_; }

 private:
  using Ball = SubtreeBall<kLanes>;
  void add(const Ball& ball);
  [[nodiscard]] double without_safety(std::span<const SkinTerm> terms);

  const JointTree::State* tree_;
  double sum_tolerance_;
  std::vector<SlideResidual> crossed_;
  std::vector<Ball> open_;  // subtrees that are not finished, ascending by node
};

/// The bound minimised over s of each joint, from several starts. For the points of a certificate
/// that matter most. The terms have no gap. Allocates.
[[nodiscard]] double refined_bound(const JointTree::State& tree, std::span<const SkinTerm> terms);

}  // namespace sunder::certificate
