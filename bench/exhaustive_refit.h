#pragma once

#include <sunder/core/skin.h>

#include <span>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder::bench {

/// The best weights and bind position of a point that can be found with patience, by other means
/// than `weights` has: every choice of bones, in each the weights by looking at all their subsets,
/// in turns with the bind position, from several beginnings, without anything that holds the bind
/// position back.
class ExhaustiveRefit {
 public:
  /// @param palettes  model_from_bind in each pose.
  ExhaustiveRefit(const AnimationPoint& exact, const Vec3d& position,
                  std::span<const std::vector<Affine3d>> palettes);

  [[nodiscard]] std::size_t bone_count() const { return slots_.size(); }
  [[nodiscard]] double mean_square(std::span<const Influence> influences,
                                   const Vec3d& position) const;
  /// Tries all supports of at most `maximum` bones, at most 8.
  /// @param start  a bind position to begin from, in addition to others.
  [[nodiscard]] double least_mean_square(std::size_t maximum, const Vec3d& start) const;

 private:
  struct Support {
    std::size_t count = 0;
    std::size_t bones[8] = {};
  };

  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;
  [[nodiscard]] const Matrix& moment(std::size_t i, std::size_t j) const {
    return moments_[i * slots_.size() + j];
  }
  [[nodiscard]] double solve_weights(const Support& support, const Eigen::Vector3d& offset,
                                     double* weights) const;
  [[nodiscard]] double solve_offset(const Support& support, const double* weights,
                                    Eigen::Vector3d& offset) const;
  [[nodiscard]] double take_turns(const Support& support, Eigen::Vector3d offset) const;

  Eigen::Vector3d position_;
  std::vector<std::uint32_t> slots_;
  std::vector<Matrix>
      moments_;  ///< Mean of N_i^T N_j, where N_i [offset; 1] is how far bone i alone would be off.
};

}  // namespace sunder::bench
