#pragma once

#include "tools/messages/messages.h"
#include "tools/plan/plan_inputs.h"
#include "tools/plan/plan_request.h"

namespace sunder::tools {

/// sunder plan --score: compares what was performed with the curve that was asked for.
/// @param inputs  as read_character() leaves them.
[[nodiscard]] ExitCode score_performed(const PlanRequest& request, const Messages& messages,
                                       PlanInputs& inputs);

}  // namespace sunder::tools
