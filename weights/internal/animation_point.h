#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <span>
#include <vector>

namespace sunder {

/// A point of a posed triangle, in the form that follows it exactly in every pose: p = sum_i M_i
/// q_i with q_i = sum_k beta_k w_ki [v_k; 1] for the corners v_k with weights w_ki. Source: Merry,
/// Marais, Gain, Animation space, TOG 2006 [merry2006animation].
class AnimationPoint {
 public:
  struct Term {
    std::uint32_t slot = 0;
    Vec4d q = Vec4d::Zero();  ///< Weight times bind position, and the weight.
  };

  void clear() { terms_.clear(); }
  /// Adds `part` times a vertex, given by its bind position (including morph displacements) and its
  /// influences. O(terms x influences).
  SUNDER_API void add(double part, const Vec3d& position, std::span<const Influence> influences);
  /// Adds `part` times another point.
  SUNDER_API void add(double part, const AnimationPoint& point);

  /// One term per slot, in order of first appearance.
  [[nodiscard]] std::span<const Term> terms() const { return terms_; }
  /// The position in a pose. @param model_from_bind  one matrix per slot of the skin.
  [[nodiscard]] SUNDER_API Vec3d posed(std::span<const Affine3d> model_from_bind) const;

 private:
  void add(std::uint32_t slot, const Vec4d& q);

  std::vector<Term> terms_;
};

}  // namespace sunder
