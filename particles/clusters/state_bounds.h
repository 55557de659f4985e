#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// How large the numbers of a recorded state can be, from the model and its decomposition.
struct StateBounds {
  /// O(points + vertices).
  StateBounds(const Structure& decomposition, const TornModel& model);

  /// Whether a point may be there in the decomposition's pose. Points that tears create lie between
  /// those of the source, but for the curvature of linear blends.
  [[nodiscard]] bool is_place(const Vec3f& place) const {
    return ((place - middle).cwiseAbs().array() <= largest).all();
  }
  /// Whether numbers of a particle are what members, faces and edges can add up to.
  [[nodiscard]] bool fits(const Particle& particle) const;

  Vec3f middle = Vec3f::Zero();  ///< Of the box around the decomposition's points.
  float largest = 0;             ///< Distance from the middle along an axis, metres.
  double member = 0;             ///< A number of one member in the sum of a bone.
  double morph = 0;              ///< The same in the sum of a morph target.
  float least_range = 0, range = 0;

 private:
  [[nodiscard]] bool fits_members(const Particle& particle) const;
  [[nodiscard]] bool fits_cell(const Particle& particle) const;

  double faces_ = 0;  ///< Their number.
};

}  // namespace sunder::particles
