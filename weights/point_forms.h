#pragma once

#include <span>
#include <vector>

#include "weights/internal/pose_moments.h"
#include "weights/simplex_solver.h"

namespace sunder::weights {

/// The mean squared error of one point over one group of poses, as a function of its weights and
/// its bind position: quadratic in each of them. Positions are about the centre of the moments.
class PointForms {
 public:
  /// @param terms  the point's, from centre_terms(); they must outlive this object's use.
  void begin(std::span<const AnimationPoint::Term> terms, const PoseMoments& moments,
             std::size_t group);

  /// The mean squared error.
  [[nodiscard]] double mean_square(std::span<const double> of_terms,
                                   const Eigen::Vector3d& position) const;
  /// Adds `factor` times the squares and products of the errors of each bone alone to the solver's
  /// matrix; because the weights sum to one, the target can be subtracted from each.
  /// @return the largest square that was added, without the target.
  double add_to_gram(const Eigen::Vector3d& position, double factor, SimplexSolver& solver);
  /// Adds `factor` times the equations of the best bind position for some weights: left * position
  /// = right.
  void add_to_equations(std::span<const double> of_terms, double factor, Eigen::Matrix3d& left,
                        Eigen::Vector3d& right) const;

 private:
  [[nodiscard]] const PoseMoments::Matrix& between(std::size_t i, std::size_t j) const {
    return between_[i * terms_.size() + j];
  }

  std::span<const AnimationPoint::Term> terms_;
  std::vector<PoseMoments::Matrix> between_;                            ///< H_ij for j >= i.
  std::vector<Eigen::Matrix<double, 4, 1, Eigen::DontAlign>> towards_;  ///< sum_j H_ij q_j.
  std::vector<double> projected_;
  double target_square_ = 0;
};

}  // namespace sunder::weights
