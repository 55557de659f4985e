#pragma once

#include <sunder/weights/point_refit.h>

#include <span>
#include <vector>

namespace sunder::weights {

/// What moving the bind position costs, as a part of its squared length: where the poses say nothing about a direction it stays.
constexpr double kStiffness = 1e-4;

/// The terms of a point about the centre of the moments, as those of weights that add up to exactly one.
void centre_terms(const AnimationPoint& point, const PoseMoments& moments, std::vector<AnimationPoint::Term>& terms);

/// The weight that each term's slot has among the influences, whose sum becomes exactly one.
void weights_of_terms(std::span<const AnimationPoint::Term> terms, std::span<const Influence> influences,
                      std::vector<double>& of_terms);

/// The weights as they are stored: those that are worth an influence, sum one, largest first.
void store_weights(std::span<const AnimationPoint::Term> terms, std::span<const double> of_terms,
                   std::vector<Influence>& influences);

/// The mean square of what these weights and bind position, which is about the centre too, are off by.
/// @param difference  memory for it.
[[nodiscard]] double mean_square(std::span<const AnimationPoint::Term> terms, std::span<const double> of_terms,
                                 const Eigen::Vector3d& position, const PoseMoments& moments,
                                 std::vector<AnimationPoint::Term>& difference);

}  // namespace sunder::weights
