#pragma once

#include <sunder/particles/soft_body.h>

#include <functional>
#include <memory>
#include <vector>

#include "support/oracles/quadratic_membrane.h"

namespace sunder::test {

/// How a surface over the unit square is meshed: the image of a regular grid.
struct GraphMesh {
  std::uint32_t cells = 80;  ///< Along each edge of the square.
  std::function<Vec2d(double u, double v)> place = [](double u, double v) {
    return Vec2d(u, v);
  };  ///< Maps the unit square to itself, one to one.
};

/// The difference of particles, or of linear elements, from a QuadraticMembrane.
struct MembraneDifference {
  double width = 0;         ///< Widest gap by that of the reference.
  double gap = 0;           ///< RMS along the slit, by the widest gap of the reference.
  double displacement = 0;  ///< RMS over all points, by half of that gap.
};

/// A GraphSurface, torn along its slit and divided into particles.
struct GraphWound {
  std::shared_ptr<const Character> character;
  std::unique_ptr<TornModel> model;
  ModelPose pose;
  std::unique_ptr<ParticleSet> set;
  std::unique_ptr<SoftBody> body;
  std::vector<LipPair> lips;
  GraphSurface surface;
  TwoMembranes materials;

  /// @param range  of the particles, metres. @param seed_order  of their seeds.
  GraphWound(const GraphSurface& surface, const TwoMembranes& materials, const GraphMesh& mesh,
             double range, std::uint64_t seed_order);

  /// The difference of the particles, in balance.
  MembraneDifference difference(const QuadraticMembrane& wanted, double newtons_per_metre);
  /// The difference of solve_membrane(), for one material only.
  [[nodiscard]] MembraneDifference difference_of_elements(const QuadraticMembrane& wanted,
                                                          double newtons_per_metre) const;

 private:
  [[nodiscard]] MembraneDifference difference_of(
      const QuadraticMembrane& wanted,
      const std::function<Vec3d(std::uint32_t point)>& displacement) const;
};

}  // namespace sunder::test
