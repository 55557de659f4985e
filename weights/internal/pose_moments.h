#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

#include <cstdint>
#include <span>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder {

/// The second moments of a set of poses: for two bones i, j of a skin the mean over the poses of
/// M_i^T M_j, a 4 x 4 matrix H_ij. The mean squared length of sum_i M_i d_i is sum_ij d_i^T H_ij
/// d_j, at a cost independent of the number of poses. It requires that the last components of the
/// d_i add up to zero, as they do for differences of points.
///
/// Matrices are taken about `centre` in bind space and about its image in each pose, so that a
/// character far from the origin loses no precision.
class SUNDER_API PoseMoments {
 public:
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

  /// @param slots  number of slots of the skin.
  PoseMoments(std::size_t slots, const Vec3d& centre);

  /// Requests the pairs of slots that move a point. All calls precede the first add(). O(terms
  /// squared).
  void want(const AnimationPoint& point);
  /// Adds a pose. O(pairs).
  void add(std::span<const Affine3d> model_from_bind);

  [[nodiscard]] std::size_t pose_count() const { return pose_count_; }
  [[nodiscard]] std::size_t pair_count() const { return pairs_.size(); }
  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// The sum of H_ij for a requested pair. @return the matrix of {low, high}; transpose it if i >
  /// j.
  [[nodiscard]] const Matrix& of(std::uint32_t low, std::uint32_t high) const {
    const Entry* entry = rows_[low].data();
    while (entry->slot != high) ++entry;
    return moments_[entry->pair];
  }
  /// sum_ij d_i^T H_ij d_j divided by the number of poses; the q of the terms are the d_i, about
  /// the centre.
  [[nodiscard]] double mean_square(std::span<const AnimationPoint::Term> difference) const;

 private:
  struct Entry {
    std::uint32_t slot, pair;
  };
  struct Pair {
    std::uint32_t low, high;
  };

  Vec3d centre_;
  /// Per slot: the slots from itself up with which it is paired.
  std::vector<std::vector<Entry>> rows_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> slots_;  ///< The slots that are in a pair.
  std::vector<Matrix> moments_;       ///< Sums over the poses, one per pair.
  std::vector<Eigen::Matrix<double, 3, 4, Eigen::DontAlign>> centred_;
  std::size_t pose_count_ = 0;
};

}  // namespace sunder
