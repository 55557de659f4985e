#pragma once

#include <sunder/animation/pull.h>

#include <cstdint>
#include <vector>

#include "skinning/animation/pull_chain.h"

namespace sunder::animation {

/// Damped least squares: each step turns the joints by the least turn that would remove the error
/// if the handles moved linearly, damped as Levenberg and Marquardt do, so that the error never
/// grows. Scratch memory is kept.
class PullSolver {
 public:
  /// Lets the chain come as near to its targets as it can, within its limits.
  /// @return the smallest error; the chain has it.
  double solve(PullChain& chain, const PullOptions& options);
  /// Steps of the last solve().
  [[nodiscard]] std::uint32_t iterations() const { return iterations_; }

 private:
  struct Column {
    std::uint32_t joint = 0;  ///< In PullChain::active().
    Vec3d axis;               ///< Of a turn by 1, in the frame of the joint's parent.
  };

  double descend(PullChain& chain, double error, const PullOptions& options);
  bool step(PullChain& chain, double& error);
  void find_columns(const PullChain& chain);
  void hold_joints(const PullChain& chain);
  void add_matrix(const PullChain& chain);
  bool find_turns(const PullChain& chain);
  bool factorise(double damping);
  void turn(PullChain& chain) const;
  void bend(PullChain& chain) const;
  static void scatter(PullChain& chain, std::uint32_t attempt);
  static void save(const PullChain& chain, std::vector<Quatd>& rotations);
  static void restore(PullChain& chain, const std::vector<Quatd>& rotations);

  std::uint32_t iterations_ = 0;
  double damping_ = 0;
  bool may_hold_ = true;
  std::vector<Column> columns_;
  std::vector<double> entries_;  ///< Of the derivative, column by column.
  std::vector<double> matrix_;   ///< J W J^T.
  std::vector<double> factor_;   ///< Its Cholesky factor, with the damping.
  std::vector<double> right_;    ///< The errors, then the multipliers.
  std::vector<Vec3d> errors_;    ///< Before the step.
  std::vector<bool> is_held_;    ///< Per active joint.
  std::vector<Vec3d> turns_;     ///< Per active joint.
  std::vector<Quatd> before_, best_;
};

}  // namespace sunder::animation
