#pragma once

#include <span>
#include <vector>

#include "weights/internal/point_refit.h"

namespace sunder::weights {

// Regularisation of a fit and the terms that both refits share; see docs/weights.md.

/// Cost of moving the bind position: this factor times the squared scale of the bones times the
/// squared distance moved.
constexpr double kStiffness = 0.03;
/// Cost of changing the weights: this factor times the squared scale of the bones times the squared
/// distance of the bones' own bind positions from the point's, times the squared change.
constexpr double kInertia = 1e-3;

/// The regularisation of one point.
struct Restraint {
  double of_position = 0;  ///< Cost per squared movement of the bind position.
  double of_weights = 0;   ///< Cost per squared change of the weights.
};
/// @param terms     from centre_terms().
/// @param position  about the centre too.
[[nodiscard]] Restraint restraint_of(std::span<const AnimationPoint::Term> terms,
                                     const Eigen::Vector3d& position, const PoseMoments& moments);

/// The terms of a point about the centre of the moments, scaled so that the weights add up to
/// exactly one.
void centre_terms(const AnimationPoint& point, const PoseMoments& moments,
                  std::vector<AnimationPoint::Term>& terms);

/// The weight of each term's slot among the influences, scaled so that the weights add up to
/// exactly one.
void weights_of_terms(std::span<const AnimationPoint::Term> terms,
                      std::span<const Influence> influences, std::vector<double>& of_terms);

/// The weights in their stored form: negligible ones dropped, sum one, descending.
void store_weights(std::span<const AnimationPoint::Term> terms, std::span<const double> of_terms,
                   std::vector<Influence>& influences);

/// The mean squared error of some weights and a bind position, which is about the centre too.
/// @param difference  scratch memory.
[[nodiscard]] double mean_square(std::span<const AnimationPoint::Term> terms,
                                 std::span<const double> of_terms, const Eigen::Vector3d& position,
                                 const PoseMoments& moments,
                                 std::vector<AnimationPoint::Term>& difference);

}  // namespace sunder::weights
