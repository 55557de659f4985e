#pragma once

#include <sunder/scene/scene_command.h>

#include <vector>

#include "core/internal/threads.h"

namespace sunder::scene {

/// A command that was submitted.
struct QueuedCommand {
  CommandId id;
  InstanceId instance;
  SceneCommand command;
  CommandOptions options;
};

/// Commands from any thread, in the order in which they came.
class CommandQueue {
 public:
  /// @throws std::bad_alloc
  CommandId push(InstanceId instance, SceneCommand command, const CommandOptions& options) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({next_, instance, std::move(command), options});
    return next_++;
  }
  /// Moves all waiting commands into `taken`, which is empty.
  void take(std::vector<QueuedCommand>& taken) noexcept {
    const std::lock_guard lock(mutex_);
    taken.swap(waiting_);
  }

 private:
  Mutex mutex_;
  std::vector<QueuedCommand> waiting_;
  CommandId next_ = 1;
};

}  // namespace sunder::scene
