#pragma once

#include <sunder/validation/transfer.h>

#include <string>

#include "tools/messages/json.h"
#include "tools/messages/lines.h"
#include "tools/verbs.h"

namespace sunder::tools {

/// A finding as it stands in reports.
[[nodiscard]] Json to_json(const Finding& finding);

/// All figures of a transfer and the options that led to them.
[[nodiscard]] Json transfer_json(const TransferRequest& request, const TransferResult& result);

/// A table for people: counts, steps that changed weights, findings.
[[nodiscard]] Lines transfer_table(const TransferRequest& request, const TransferResult& result);

}  // namespace sunder::tools
