#pragma once

#include <array>

#include "particles/motion/damped_spring.h"
#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// A pull on a point, that is on a weighted sum of displacements.
struct PointPull {
  std::array<Index, 4> particles = {};
  std::array<double, 4> weights = {};  ///< 0 where there are fewer particles.
  double stiffness = 0;                ///< Newtons per metre.
  double frequency = 0;                ///< Root of the stiffness by mass; radians per second.
  Vec3d target = Vec3d::Zero();        ///< Of the weighted sum, metres.
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
/// particles have different responses, their spring uses the greater S / G of both. Solved by
/// conjugate gradients, starting from the solution of the last step.
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

  ///
  /// @param corrections  per particle: x, computed. Input: the start of the search.
  /// @return the number of iterations. O(iterations x springs of `active`); no allocation once
  ///         warm.
  int solve(const Inputs& inputs, std::span<Vec3d> corrections);

  [[nodiscard]] std::size_t memory_bytes() const {
    return (row_of_.capacity() + first_.capacity()) * sizeof(Index) +
           entries_.capacity() * sizeof(Entry) + pulls_.capacity() * sizeof(ActivePull) +
           (diagonal_.capacity() + inverse_.capacity() + ratios_.capacity()) * sizeof(double) +
           5 * x_.capacity() * sizeof(Vec4);
  }

 private:
  using Vec4 = Eigen::Vector4d;  // three coordinates; the fourth fills two registers of two
  struct Entry {
    Index column = 0;
    double value = 0;
  };
  struct ActivePull {
    std::array<Index, 4> rows = {};
    std::array<double, 4> weights = {};
    double stiffness = 0;
  };

  void assemble(const Inputs& inputs);
  void assemble_pulls(const Inputs& inputs);
  /// product = A x
  void multiply(const std::vector<Vec4>& x, std::vector<Vec4>& product) const;

  std::vector<Index> row_of_;  // kNone for a particle that does not move
  std::vector<Index> first_;
  std::vector<Entry> entries_;
  std::vector<double> diagonal_, inverse_;
  std::vector<double> ratios_;  // velocity per place, per material
  std::vector<ActivePull> pulls_;
  std::vector<Vec4> x_, right_, residual_, direction_, product_;
};

}  // namespace sunder::particles
