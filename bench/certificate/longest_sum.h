#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace sunder::bench {

/// A joint of a small tree of rigid bones: Y = own + sum over children of R_child Y_child.
struct SumJoint {
  std::uint32_t parent = 0;  ///< Of a smaller index; the first joint is the top and does not turn.
  bool is_hinge = false;
  double angle = 0.0;                ///< A ball turns by at most so much, a hinge to either side.
  Eigen::Vector3d axis = {1, 0, 0};  ///< Hinge; unit length.
  Eigen::Vector3d own = {0, 0, 0};
};

/// The largest length of the top's sum lies in [least, most].
struct LongestSum {
  double least = 0.0, most = 0.0;
  std::uint64_t cells = 0;
};

/// Branch and bound over the rotations of all joints, by none of the code of the certificate. Ends
/// when most <= (1 + accuracy) * least, or after `most_cells` cells with what is then known.
[[nodiscard]] LongestSum longest_sum(const std::vector<SumJoint>& joints, double accuracy,
                                     std::uint64_t most_cells);

}  // namespace sunder::bench
