#pragma once

#include "tear/model/instance.h"
#include "tear/model/model_state.h"

namespace sunder::tear {

/// The state of a model that was unpacked, for queries and previews. A preview changes it for the
/// time of its call.
struct ModelAccess {
  [[nodiscard]] static auto& state_of(const TornModel& model) { return *model.state_; }
  [[nodiscard]] static const std::shared_ptr<const TornAsset>& asset_of(const TornModel& model) {
    return model.state_.instance->asset;
  }
  /// Those of the asset, which all its models share.
  [[nodiscard]] static const SourceTrees& trees_of(const TornModel& model) {
    return *model.state_.instance->parts().trees;
  }
};

}  // namespace sunder::tear
