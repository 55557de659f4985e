#pragma once

#include <span>
#include <vector>

#include "certificate/joint_path.h"

namespace sunder::certificate {

/// Certified bounds of single points, without allocation. Not shared between threads.
class PointBound {
 public:
  /// @param most_terms  that a point may have.
  PointBound(const JointTree::State& tree, std::size_t most_terms);

  /// The least of kLanes bounds, with safety for rounding; infinity if there is a gap.
  [[nodiscard]] double of(std::span<const SkinTerm> terms);

 private:
  using Ball = SubtreeBall<kLanes>;
  void add(const Ball& ball);
  [[nodiscard]] double without_safety(std::span<const SkinTerm> terms);

  const JointTree::State* tree_;
  std::vector<Ball> open_;  // subtrees that are not finished, ascending by node
};

/// The bound minimised over s of each joint, from several starts. The points of a certificate that
/// matter most. The terms have no gap. Allocates.
[[nodiscard]] double refined_bound(const JointTree::State& tree, std::span<const SkinTerm> terms);

}  // namespace sunder::certificate
