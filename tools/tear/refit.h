#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sunder::tools {

/// Reads the value of --refit-over: poses separated by commas, each `clips`, `clips:NAME` or
/// `range_of_motion`, with `=FACTOR` after it if it counts more or less than 1. A clip that is
/// named has its factor among the clips, which all count.
/// @return the options of a fit over these poses; invalid_argument that names the part at fault.
[[nodiscard]] Result<RefitOptions> parse_refit_over(const std::string& text);

/// The same text for options of a fit.
[[nodiscard]] std::string refit_over_text(const RefitOptions& options);

/// @param asked  if empty: over the clips and the range of motion, or what the character has.
/// @return empty if nothing was asked for and the character has neither: it does not bend, so there
///         is nothing to fit.
[[nodiscard]] Result<std::optional<RefitOptions>> choose_refit(
    const Character& character, const std::optional<RefitOptions>& asked);

/// Replaces the range of motion by the joint limits of a robot, for the bones that have the names
/// of its links. @return the failures of load_robot(); not_found if there is no such bone.
[[nodiscard]] Status limit_range_of_motion(const std::filesystem::path& urdf,
                                           const Character& character, RefitOptions& options);

/// The operations that fit all points of a history that are not fitted yet: points of the policy
/// `refit` that no later operation reweighed. Successive operations with the same weights are
/// fitted together.
[[nodiscard]] std::vector<WeightsOperation> refits_of(const std::vector<Operation>& history,
                                                      const RefitOptions& options);

}  // namespace sunder::tools
