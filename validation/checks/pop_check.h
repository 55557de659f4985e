#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>
#include <optional>

#include "validation/checks/finding_list.h"

namespace sunder::validation {

/// Plays a log on the source and reports how far each operation moves the posed surface at its
/// moment. @return the torn model; none if an operation fails, which is a finding.
[[nodiscard]] std::optional<TornModel> check_pops(const std::shared_ptr<const Character>& source,
                                                  std::span<const Operation> operations,
                                                  double diagonal, FindingList& findings);

}  // namespace sunder::validation
