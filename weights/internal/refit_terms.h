#pragma once

#include <span>
#include <vector>

#include "weights/internal/point_refit.h"

namespace sunder::weights {

// Regularisation of a fit and the terms that both refits share; see docs/method/weights.md.

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
/// @param group     of the moments, that is minimised.
[[nodiscard]] SUNDER_API Restraint restraint_of(std::span<const AnimationPoint::Term> terms,
                                                const Eigen::Vector3d& position,
                                                const PoseMoments& moments, std::size_t group);

/// The terms of a point about the centre of the moments, scaled so that the weights add up to
/// exactly one.
SUNDER_API void centre_terms(const AnimationPoint& point, const PoseMoments& moments,
                             std::vector<AnimationPoint::Term>& terms);

/// The weight of each term's slot among the influences, scaled so that the weights add up to
/// exactly one.
SUNDER_API void weights_of_terms(std::span<const AnimationPoint::Term> terms,
                                 std::span<const Influence> influences,
                                 std::vector<double>& of_terms);

/// The weights in their stored form: negligible ones dropped, sum one, descending.
SUNDER_API void store_weights(std::span<const AnimationPoint::Term> terms,
                              std::span<const double> of_terms, std::vector<Influence>& influences);

/// The difference between a point with some weights and bind position and the exact one.
/// @param difference  overwritten.
SUNDER_API void differences(std::span<const AnimationPoint::Term> terms,
                            std::span<const double> of_terms, const Eigen::Vector3d& position,
                            std::vector<AnimationPoint::Term>& difference);

/// Computes the mean squared errors over all groups with a bound, relative to what is allowed:
/// those of the moments, then that of the point's own poses.
/// @param difference  from differences().
/// @param excess      overwritten.
/// @return whether one is exceeded.
[[nodiscard]] SUNDER_API bool exceeds_bounds(const PointToRefit& point, const PoseMoments& moments,
                                             std::span<const AnimationPoint::Term> difference,
                                             std::vector<double>& excess);

}  // namespace sunder::weights
