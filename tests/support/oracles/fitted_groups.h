#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <cstdint>
#include <vector>

namespace sunder::test {

/// The points of one operation over one group of poses to which a refit fits: their root mean
/// square errors, metres. Points are posed as a skinned mesh poses them, from stored floats, one
/// pose after the other.
struct FittedGroup {
  std::uint32_t operation = 0;
  std::size_t group = 0;  ///< Of tear::RefitPoses; the next number: the poses of the operation.
  double barycentric = 0, fitted = 0;

  /// The first divided by the second; neither counts as less than `nothing`.
  [[nodiscard]] double gain(double nothing) const;
};

/// Fits the points of a model by reweigh() and measures every group of each operation that has
/// points, with barycentric weights of as many influences and with the fits. The model keeps the
/// fits.
/// @param wanted  all operations, policy `refit`.
[[nodiscard]] std::vector<FittedGroup> refit_and_measure(TornModel& model,
                                                         const WeightsOperation& wanted);

/// How many of the groups are worse than with barycentric weights by more than 1e-9 of the error.
/// @param nothing  a root mean square error that is rounding, metres.
[[nodiscard]] std::size_t count_lost(const std::vector<FittedGroup>& groups, double nothing);

}  // namespace sunder::test
