#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "particles/motion/factor_pattern.h"
#include "particles/motion/spring_matrix.h"

namespace sunder::particles {

/// The factor L D L^T of a spring matrix, with all entries that elimination adds. Eliminating a
/// node replaces its springs by springs between its neighbours, as in the star-mesh transform of
/// electrical networks, so only positive numbers are added: that part of the factor has full
/// precision however much stiffnesses differ (Alfa, Xue, Ye, 2002).
class CouplingFactor {
 public:
  using Vec4 = Eigen::Vector4d;  // three coordinates; the fourth fills two registers of two

  /// Prepares for matrices of a pattern. O(entries of the factor); no allocation once warm.
  /// @throws std::bad_alloc
  void analyse(const SpringMatrix::Pattern& pattern);
  /// Computes the factor of a matrix of the pattern that was analysed last. No allocation.
  void factorise(const SpringMatrix& matrix);
  /// Replaces a right-hand side by its solution. O(entries of the factor).
  void solve(std::span<Vec4> x);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  using Group = FactorPattern::Group;

  void eliminate(const Group& group);
  void update_targets(const Group& group);
  void eliminate_pulls(const SpringMatrix& matrix);
  void reduce();
  void replace_back();

  FactorPattern pattern_;
  std::vector<double> panels_;                   // of -L
  std::vector<double> inverse_pivots_;           // per place
  std::vector<double> pivots_, factors_, sums_;  // of the group that is eliminated
  std::vector<Vec4> x_;                          // per place
};

}  // namespace sunder::particles
