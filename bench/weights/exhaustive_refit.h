#pragma once

#include <sunder/core/skin.h>

#include <span>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder::bench {

/// A reference for the best weights and bind position of a point, by other means than `weights`
/// has. For every choice of bones it alternates between the weights, by trying all subsets, and the
/// bind position, from several starts, without regularisation of the bind position.
class ExhaustiveRefit {
 public:
  /// @param palettes  model_from_bind in each pose.
  ExhaustiveRefit(const AnimationPoint& exact, const Vec3d& position,
                  std::span<const std::vector<Affine3d>> palettes);

  [[nodiscard]] std::size_t bone_count() const { return slots_.size(); }
  [[nodiscard]] double mean_square(std::span<const Influence> influences,
                                   const Vec3d& position) const;
  /// Tries all supports of at most `maximum` bones, at most 8.
  /// @param start  a bind position to start from, in addition to others.
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
      /// Mean of N_i^T N_j, where N_i [offset; 1] is the error if bone i had all the weight.
      moments_;
};

}  // namespace sunder::bench
