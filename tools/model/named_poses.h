#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/aimed_operation.h>
#include <sunder/operation/operation.h>

#include <string>

namespace sunder::tools {

/// "; did you mean 'Walk'?" for the first clip or bone that a pose names and the character does not
/// have. Empty if it has all.
[[nodiscard]] std::string advice_on_names(const PoseSpec& spec, const Character& character);
/// The same for the poses of an operation.
[[nodiscard]] std::string advice_on_names(const Operation& operation, const Character& character);
/// The same for the clip of an operation that names a bone; without that bone, how to list them.
[[nodiscard]] std::string advice_on_names(const AimedOperation& operation,
                                          const Character& character);
/// The same for the clips of a refit.
[[nodiscard]] std::string advice_on_names(const RefitOptions& refit, const Character& character);

}  // namespace sunder::tools
