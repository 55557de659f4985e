#pragma once

#include "tear/model/model_state.h"

namespace sunder::tear {

/// The state of a model that was unpacked, for queries and previews. A preview changes it for the
/// time of its call.
struct ModelAccess {
  [[nodiscard]] static auto& state_of(const TornModel& model) { return *model.state_; }
};

}  // namespace sunder::tear
