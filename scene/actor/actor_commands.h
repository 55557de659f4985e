#pragma once

#include <sunder/scene/character_instance.h>

#include <memory>
#include <optional>
#include <vector>

#include "scene/actor/command_calls.h"
#include "scene/actor/command_queue.h"
#include "scene/threads/background.h"
#include "scene/threads/once_job.h"

namespace sunder::scene {

/// The commands of one instance: those that wait, those that run in the background, and the results
/// of the last update.
class ActorCommands {
 public:
  void push(QueuedCommand&& queued) { waiting_.push_back(std::move(queued)); }
  /// Applies the waiting commands in order, up to one that waits for the background. Those of
  /// strokes do not wait; what runs in the background is done again after them.
  void apply(const ModelPose& pose, CharacterInstance& instance, Background& background);
  /// Swaps in what finished in the background. A refit waits while other commands do, so that a
  /// frame that tears does no more than that, and unless it may be swapped in.
  /// @return whether one was.
  bool finish_background(CharacterInstance& instance, Background& background, bool may_refit);

  /// Whether there are commands that wait.
  [[nodiscard]] bool has_waiting() const { return !waiting_.empty(); }
  [[nodiscard]] Index background_count() const {
    return static_cast<Index>(refits_.size()) + (operation_ ? 1 : 0);
  }
  [[nodiscard]] bool has_refits() const { return !refits_.empty(); }
  /// Results of the last update, to be taken.
  [[nodiscard]] std::vector<CommandResult>& results() { return results_; }
  /// Ends all commands that are not done. @throws std::bad_alloc
  void abandon(const Status& why);
  void clear() noexcept {
    waiting_ = {};
    results_ = {};
  }

 private:
  struct InBackground {
    QueuedCommand queued;
    std::shared_ptr<OnceJob> job;
    SwapTime time;
  };
  struct RunningOperation {
    InBackground in_background;
    Operation operation;  ///< In the pose of the update that took it.
    std::optional<OperationJob> job;
    /// The asset of the piece that a detachment takes off. The job writes it before it is done.
    std::shared_ptr<std::shared_ptr<const CharacterAsset>> asset;
    bool is_outdated = false;  ///< Whether a stroke has changed the instance since.
  };
  struct RunningRefit {
    InBackground in_background;
    RefitJob job;
  };
  CommandResult& add_result(const QueuedCommand& queued);
  void conclude(const QueuedCommand& queued, Result<TearReport> report);
  void give(DetachedParts parts);
  Status start(const QueuedCommand& queued, const ModelPose& pose, CharacterInstance& instance,
               Background& background);
  Status start_operation(RunningOperation& operation, CharacterInstance& instance,
                         Background& background);
  void finish_operation(CharacterInstance& instance, Background& background);
  bool finish_refits(CharacterInstance& instance);

  std::vector<QueuedCommand> waiting_;
  std::unique_ptr<RunningOperation> operation_;  ///< Null: none. Most instances never have one.
  std::vector<RunningRefit> refits_;
  std::vector<CommandResult> results_;
};

}  // namespace sunder::scene
