#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <optional>
#include <vector>

namespace sunder::tools {

/// The poses of the option --refit-over.
enum class RefitOver { clips, range_of_motion, both };

/// "clips", "range_of_motion" or "both", as --refit-over takes it.
[[nodiscard]] const char* refit_over_name(RefitOver over);

/// The pose set of the option.
[[nodiscard]] PoseSetSpec pose_set_of(RefitOver over);

///
/// @param asked  if empty: both, or what the character has.
/// @return empty if nothing was asked for and the character has neither: it does not bend, so there
///         is nothing to fit.
[[nodiscard]] Result<std::optional<RefitOver>> choose_poses(
    std::shared_ptr<const Character> character, std::optional<RefitOver> asked);

/// The operations that fit all points of a history that are not fitted yet: points of the policy
/// `refit` that no later operation reweighed. Successive operations with the same weights are
/// fitted together.
[[nodiscard]] std::vector<WeightsOperation> refits_of(const std::vector<Operation>& history,
                                                      RefitOver over);

}  // namespace sunder::tools
