#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <optional>
#include <vector>

namespace sunder::tools {

/// --refit-over
enum class RefitOver { clips, range_of_motion, both };

/// "clips", "range_of_motion" or "both", as --refit-over takes it.
[[nodiscard]] const char* refit_over_name(RefitOver over);

/// What that is over.
[[nodiscard]] PoseSetSpec pose_set_of(RefitOver over);

/// @param asked  none: both, as far as the character has them.
/// @return none where it was not asked for and the character has neither: then it does not bend,
/// and nothing is to be fitted.
[[nodiscard]] Result<std::optional<RefitOver>> choose_poses(
    std::shared_ptr<const Character> character, std::optional<RefitOver> asked);

/// The operations that fit what waits for it in a history: points of policy `refit` to which no
/// operation gave other weights since. Operations that follow one another with the same weights are
/// fitted together.
[[nodiscard]] std::vector<WeightsOperation> refits_of(const std::vector<Operation>& history,
                                                      RefitOver over);

}  // namespace sunder::tools
