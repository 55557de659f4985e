#pragma once

#include <sunder/particles/bullet_body.h>

#include <vector>

namespace sunder::particles {

/// One column of values per particle.
using Columns = Eigen::Matrix3Xd;

/// A spring over one substep: (1 + damping) v' = v - stiffness x, then x' = x + h v'.
struct SubstepSpring {
  double damping = 0;
  double stiffness = 0;  ///< 1/s.
};

/// The springs of particles in a Bullet world over one substep: to the rest place, and between
/// neighbours.
class SubstepSprings {
 public:
  explicit SubstepSprings(const BulletBodyOptions& options);

  /// A spring between two neighbours.
  struct Pair {
    Index a = 0, b = 0;
    double share = 0;      ///< Of the mass of either end that this spring moves.
    double frequency = 0;  ///< Of that share, radians per second.
    SubstepSpring spring;  ///< Times the share.
  };
  [[nodiscard]] std::vector<Pair> pairs_of(const ParticleSet& set) const;
  /// Makes room for a number of particles; the springs do not change until connect(). @throws
  /// std::bad_alloc
  void make_room(Index count);
  ///
  /// @param pairs  pairs_of() a set for whose particles there is room.
  void connect(std::vector<Pair> pairs);

  /// Computes the springs for a substep. @return whether its length differs from the previous one.
  bool set_substep(double seconds);
  /// Makes the next set_substep() recompute the springs.
  void forget_substep() { springs_for_ = 0; }
  [[nodiscard]] const SubstepSpring& return_spring() const { return return_spring_; }

  /// Velocities after the substep, relative to rest: A v = relative - stiffness displaced, by
  /// conjugate gradients with the diagonal as preconditioner.
  /// @param held  per particle: 1 where its velocity stays.
  const Columns& solve(const Columns& relative, const Columns& displaced,
                       const std::vector<char>& held);

 private:
  void multiply(const Columns& x, Columns& y, const std::vector<char>& held) const;
  [[nodiscard]] double weighted(const Columns& x) const;

  double return_frequency_;  ///< Radians per second.
  double neighbour_stiffness_, damping_ratio_;
  std::vector<Pair> pairs_;
  double springs_for_ = 0;  ///< The substep that the springs were computed for.
  SubstepSpring return_spring_;
  Eigen::VectorXd diagonal_;
  Columns solved_, residual_, direction_, product_;
};

}  // namespace sunder::particles
