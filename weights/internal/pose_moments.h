#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

#include <cstdint>
#include <span>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder {

/// What a set of poses means for squared distances: for two bones i, j of a skin the mean over the
/// poses of M_i^T M_j, a 4 x 4 matrix. The mean squared length of sum_i M_i d_i is then sum_ij
/// d_i^T H_ij d_j, at a cost that does not depend on how many poses there are. Holds for terms
/// whose last components add up to zero: differences of points.
///
/// Matrices are taken about `centre` in bind space and about where the bones carry it in each pose,
/// so that a character that stands far from the origin loses no digits.
class SUNDER_API PoseMoments {
 public:
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

  /// @param slots  of the skin.
  PoseMoments(std::size_t slots, const Vec3d& centre);

  /// Asks for the pairs of the slots that move a point. To be called for all points before the
  /// first add(). O(terms squared).
  void want(const AnimationPoint& point);
  /// Adds a pose. O(pairs).
  void add(std::span<const Affine3d> model_from_bind);

  [[nodiscard]] std::size_t pose_count() const { return pose_count_; }
  [[nodiscard]] std::size_t pair_count() const { return pairs_.size(); }
  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// H_ij. Only of pairs that were asked for. @return the matrix of {low, high}, to be transposed
  /// where i > j.
  [[nodiscard]] const Matrix& of(std::uint32_t low, std::uint32_t high) const {
    const Entry* entry = rows_[low].data();
    while (entry->slot != high) ++entry;
    return moments_[entry->pair];
  }
  /// sum_ij d_i^T H_ij d_j over the number of poses; the q of the terms are the d_i, about the
  /// centre.
  [[nodiscard]] double mean_square(std::span<const AnimationPoint::Term> difference) const;

 private:
  struct Entry {
    std::uint32_t slot, pair;
  };
  struct Pair {
    std::uint32_t low, high;
  };

  Vec3d centre_;
  std::vector<std::vector<Entry>>
      rows_;  ///< Of each slot: the slots from itself up that it is paired with.
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> slots_;  ///< That are in a pair.
  std::vector<Matrix> moments_;       ///< Sums over the poses.
  std::vector<Eigen::Matrix<double, 3, 4, Eigen::DontAlign>> centred_;
  std::size_t pose_count_ = 0;
};

}  // namespace sunder
