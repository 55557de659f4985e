#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

#include <cstdint>
#include <span>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder {

/// The second moments of groups of poses: for two bones i, j of a skin and each group the mean over
/// its poses of M_i^T M_j, a 4 x 4 matrix H_ij. The mean squared length of sum_i M_i d_i is sum_ij
/// d_i^T H_ij d_j, at a cost independent of the number of poses. It requires that the last
/// components of the d_i add up to zero, as they do for differences of points.
///
/// Matrices are taken about `centre` in bind space and about its image in each pose, so that a
/// character far from the origin loses no precision.
class SUNDER_API PoseMoments {
 public:
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

  /// @param slots   number of slots of the skin.
  /// @param groups  number of groups of poses, at least 1.
  PoseMoments(std::size_t slots, const Vec3d& centre, std::size_t groups = 1);

  /// Requests the pairs of slots that move a point. All calls precede the first add(). O(terms
  /// squared).
  void want(const AnimationPoint& point);
  /// Adds a pose to a group. @param weight  how much it counts; their mean over a group is 1.
  /// O(pairs).
  void add(std::span<const Affine3d> model_from_bind, std::size_t group = 0, double weight = 1);
  /// Replaces a group by the weighted sum of the means of the other ones, as if it had one pose.
  /// @param factors  one per group; that of `into` is not read. O(pairs x groups).
  void combine(std::span<const double> factors, std::size_t into);

  [[nodiscard]] std::size_t group_count() const { return pose_counts_.size(); }
  [[nodiscard]] std::size_t pose_count(std::size_t group = 0) const { return pose_counts_[group]; }
  [[nodiscard]] std::size_t pair_count() const { return pairs_.size(); }
  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// Whether a slot is that of a requested point.
  [[nodiscard]] bool has(std::uint32_t slot) const { return !rows_[slot].empty(); }
  /// The sum of H_ij over the poses of a group for a requested pair. @return the matrix of {low,
  /// high}; transpose it if i > j.
  [[nodiscard]] const Matrix& of(std::uint32_t low, std::uint32_t high,
                                 std::size_t group = 0) const {
    return moments_[group * pairs_.size() + pair_of(low, high)];
  }
  /// sum_ij d_i^T H_ij d_j divided by the number of poses of a group; 0 without poses. The q of the
  /// terms are the d_i, about the centre.
  [[nodiscard]] double mean_square(std::span<const AnimationPoint::Term> difference,
                                   std::size_t group = 0) const;
  /// The same for the first groups at once. @param of_groups  one per group, overwritten.
  /// O(terms squared x groups).
  void mean_squares(std::span<const AnimationPoint::Term> difference,
                    std::span<double> of_groups) const;

 private:
  struct Entry {
    std::uint32_t slot, pair;
  };
  struct Pair {
    std::uint32_t low, high;
  };
  [[nodiscard]] std::size_t pair_of(std::uint32_t low, std::uint32_t high) const {
    const Entry* entry = rows_[low].data();
    while (entry->slot != high) ++entry;
    return entry->pair;
  }

  Vec3d centre_;
  /// Per slot: the slots from itself up with which it is paired.
  std::vector<std::vector<Entry>> rows_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> slots_;  ///< The slots that are in a pair.
  /// Sums over the poses: all pairs of the first group, then those of the next.
  std::vector<Matrix> moments_;
  std::vector<Eigen::Matrix<double, 3, 4, Eigen::DontAlign>> centred_;
  std::vector<std::size_t> pose_counts_;  ///< Per group.
};

}  // namespace sunder
