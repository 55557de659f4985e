#pragma once

#include <array>

#include "particles/motion/coupling_factor.h"
#include "particles/motion/damped_spring.h"
#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// A pull on a weighted sum of displacements: that of a point, or of the way between two.
struct PointPull {
  static constexpr std::size_t kMost = 8;
  std::array<Index, kMost> particles = {};  ///< Each once.
  std::array<double, kMost> weights = {};   ///< 0 where there are fewer particles.
  double stiffness = 0;                     ///< Newtons per metre.
  double frequency = 0;                     ///< Root of the stiffness by mass; radians per second.
  Vec3d target = Vec3d::Zero();             ///< Of the weighted sum, metres.
};

/// Solves for the contribution of springs between particles, and of pulls on points, to a step in
/// which each particle has a return spring of its own.
///
/// Without these, a particle ends the step by the closed form (SpringStep): place p, velocity q.
/// Forces F of neighbours and pulls are constant during the step, with their values at its end. The
/// place becomes p + x with x = G F / m, the velocity q + (S / G) x, where G and S are the
/// particle's responses to an acceleration. With K and D the stiffness and damping of all springs,
///
///   (m / G + K + D S / G) x = -(K p + D q),
///
/// which is symmetric and positive definite for any step, and exact for the return springs. If two
/// particles have different responses, their spring uses the greater S / G of both. Solved by a
/// factor, which is kept as long as the matrix stays the same.
class CouplingSolver {
 public:
  struct Inputs {
    const SpringGraph& graph;
    /// Particles that move, ascending; the others keep their places.
    std::span<const Index> active;
    std::span<const SpringStep> steps;   ///< Per material.
    std::span<const Index> material_of;  ///< Per particle.
    /// Per particle: p, q; if it does not move, u and 0.
    std::span<const Vec3d> places, velocities;
    std::span<const PointPull> pulls;
    double seconds = 0;
  };

  /// O(particles + entries of the factor), and a multiple if the matrix changed; no allocation once
  /// warm. The result depends on the inputs alone.
  /// @param corrections  per particle: x, written for those of `active`.
  void solve(const Inputs& inputs, std::span<Vec3d> corrections);

  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  using Vec4 = CouplingFactor::Vec4;
  /// A particle of a pull, by its row and that of the pull.
  struct PullEntry {
    Index row = 0, column = 0;
    double weight = 0;
  };

  void find_rows(const Inputs& inputs);
  void assemble(const Inputs& inputs);
  void assemble_springs(const Inputs& inputs, Index row);
  void assemble_still(const Inputs& inputs, Index row);
  void assemble_pull(const Inputs& inputs, const PointPull& pull);

  void add_entry(Index column, double value) {
    matrix_.pattern.columns.push_back(column);
    matrix_.values.push_back(value);
  }

  std::vector<Index> rows_;          // the particle of each row, ascending
  std::vector<std::uint8_t> moves_;  // per particle
  std::vector<Index> row_of_;        // kNone for a particle without a row
  std::vector<double> ratios_;       // velocity per place, per material
  std::vector<PullEntry> pull_entries_;
  SpringMatrix matrix_, factorised_;
  CouplingFactor factor_;
  std::vector<Vec4> x_;  // the right-hand side, then the solution
};

}  // namespace sunder::particles
