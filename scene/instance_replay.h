#pragma once

#include <sunder/scene/character_instance.h>

namespace sunder::scene {

/// Applies the operations of a snapshot to a new instance. It gets no soft body, which would have
/// to follow them: restore_tissue() then makes what came of it.
class InstanceReplay {
 public:
  explicit InstanceReplay(CharacterInstance& instance) : state_(*instance.state_) {}

  /// Makes the torn model. @return as CharacterInstance::prepare_to_tear().
  Status begin();
  /// @return as apply_operation().
  Status apply(const Operation& operation);
  Status undo();
  /// Makes what the first drawing makes, so that the frame that shows the instance first need not.
  /// The next draw() still counts as one that changes vertices. Does nothing without a pose.
  /// @return as CharacterInstance::draw().
  Status draw();

 private:
  CharacterInstance::State& state_;
};

}  // namespace sunder::scene
