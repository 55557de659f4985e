#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>
#include <sunder/operation/operation.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "tools/budget/budget.h"

namespace sunder::tools {

/// Reads an operation log and turns operations that name bones into plain ones, each for the model
/// as the operations before it leave it.
/// @param budget  told which operation is applied.
/// @return the failures of load_aimed_operations(), resolve() and apply_operation(); the text names
///         the operation.
[[nodiscard]] Result<std::vector<Operation>> load_plain_operations(
    const std::filesystem::path& file, const std::shared_ptr<const Character>& character,
    Budget& budget);

}  // namespace sunder::tools
