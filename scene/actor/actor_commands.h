#pragma once

#include <sunder/scene/character_instance.h>

#include <optional>
#include <vector>

#include "scene/actor/command_queue.h"
#include "scene/threads/background.h"

namespace sunder::scene {

/// The commands of one instance: those that wait, those that run in the background, and the results
/// of the last update.
class ActorCommands {
 public:
  void push(QueuedCommand&& queued) { waiting_.push_back(std::move(queued)); }
  /// Applies the waiting commands in order, up to one that waits for the background.
  void apply(const ModelPose& pose, CharacterInstance& instance, Background& background);
  /// Swaps in what finished in the background. A refit waits while other commands do, so that a
  /// frame that tears does no more than that.
  void finish_background(CharacterInstance& instance);

  /// Whether there are commands that wait.
  [[nodiscard]] bool has_waiting() const { return !waiting_.empty(); }
  [[nodiscard]] Index background_count() const {
    return static_cast<Index>(refits_.size()) + (operation_ ? 1 : 0);
  }
  /// Results of the last update, to be taken.
  [[nodiscard]] std::vector<CommandResult>& results() { return results_; }
  /// Ends all commands that are not done. @throws std::bad_alloc
  void abandon(const Status& why);
  void clear() noexcept {
    waiting_ = {};
    results_ = {};
  }

 private:
  template <class Job>
  struct InBackground {
    QueuedCommand queued;
    Job job;
  };
  CommandResult& add_result(const QueuedCommand& queued);
  void conclude(const QueuedCommand& queued, Result<TearReport> report);
  Status start(const QueuedCommand& queued, const ModelPose& pose, CharacterInstance& instance,
               Background& background);
  void finish_operation(CharacterInstance& instance);
  void finish_refits(CharacterInstance& instance);

  std::vector<QueuedCommand> waiting_;
  std::optional<InBackground<OperationJob>> operation_;
  std::vector<InBackground<RefitJob>> refits_;
  std::vector<CommandResult> results_;
};

}  // namespace sunder::scene
