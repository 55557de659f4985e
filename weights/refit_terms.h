#pragma once

#include <span>
#include <vector>

#include "weights/internal/point_refit.h"

namespace sunder::weights {

// What a fit is held back by, so that it does not go wrong in other poses for the sake of nothing
// in these: docs/weights.md.

/// By the squared scale of the bones, times how far the bind position is moved, squared.
constexpr double kStiffness = 0.03;
/// By the same, and by the squared distance of the bones' own bind positions from the point's;
/// times how much the weights are changed, squared.
constexpr double kInertia = 1e-3;

/// What a point is held back by.
struct Restraint {
  double of_position = 0;  ///< Cost of the bind position's squared movement.
  double of_weights = 0;   ///< Cost of the weights' squared change.
};
/// @param terms     of centre_terms().
/// @param position  about the centre too.
[[nodiscard]] Restraint restraint_of(std::span<const AnimationPoint::Term> terms,
                                     const Eigen::Vector3d& position, const PoseMoments& moments);

/// The terms of a point about the centre of the moments, as those of weights that add up to exactly
/// one.
void centre_terms(const AnimationPoint& point, const PoseMoments& moments,
                  std::vector<AnimationPoint::Term>& terms);

/// The weight that each term's slot has among the influences, whose sum becomes exactly one.
void weights_of_terms(std::span<const AnimationPoint::Term> terms,
                      std::span<const Influence> influences, std::vector<double>& of_terms);

/// The weights as they are stored: those that are worth an influence, sum one, largest first.
void store_weights(std::span<const AnimationPoint::Term> terms, std::span<const double> of_terms,
                   std::vector<Influence>& influences);

/// The mean square of what these weights and bind position, which is about the centre too, are off
/// by.
/// @param difference  memory for it.
[[nodiscard]] double mean_square(std::span<const AnimationPoint::Term> terms,
                                 std::span<const double> of_terms, const Eigen::Vector3d& position,
                                 const PoseMoments& moments,
                                 std::vector<AnimationPoint::Term>& difference);

}  // namespace sunder::weights
