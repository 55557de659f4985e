#pragma once

#include <sunder/tear/torn_model.h>

#include <functional>
#include <memory>
#include <span>

namespace sunder {
namespace tear {
struct OperationTask;
}

/// A large operation, such as a cut through a million points, that runs in the background while its
/// model is drawn:
///
///   auto job = OperationJob::create(model, operation);    // this frame
///   std::thread worker([job] { job->run(); });            // or the host's job system
///   if (job->poll() == OperationJob::State::done) job->swap_in(model, &change);  // a later frame
///
/// The operation runs on a replica of the model; swap_in() takes over what it changed. Copies refer
/// to the same job. run() and poll() may be called from any thread; create() and swap_in() only
/// from the thread that uses the model.
class SUNDER_API OperationJob {
 public:
  enum class State : std::uint8_t { waiting, running, done, failed, swapped_in };

  /// Sees the replica with the operation done, and its records, before run() returns: to prepare on
  /// the same thread what follows the operation.
  using Observer =
      std::function<void(const TornModel& replica, std::span<const ChangeRecord> changes)>;

  /// Copies the history of the model. @param operation  not an undo or redo.
  /// @param observer  optional; throws nothing but std::bad_alloc.
  /// @return invalid_argument for those and while a stroke is in progress; as
  ///         TornModel::history(). O(size of the operations), allocates.
  static Result<OperationJob> create(TornModel& model, const Operation& operation,
                                     Observer observer = {});
  /// A detachment whose piece is wanted: it is made in run(); see detach() of a model.
  /// @return as above.
  static Result<OperationJob> create(TornModel& model, const DetachOperation& operation,
                                     const DetachOptions& options, Observer observer = {});
  /// Replays the history and runs the operation. Call it once, on any thread; it does not access
  /// the model. O(size of the model + its operations). The result has the same bits as the call of
  /// the operation.
  void run() const;
  [[nodiscard]] State poll() const;
  /// The cause, if poll() returns `failed`: what the call of the operation returns.
  [[nodiscard]] const Status& failure() const;
  /// The piece of a detachment with options, once poll() returns `done`; null for other operations.
  [[nodiscard]] std::shared_ptr<const DetachedPiece> piece() const;
  /// Makes the model as if the operation had been called now. O(changes by the operation).
  /// @return invalid_argument for a job that is not done, or if the model has changed since
  ///         create(); capacity_exceeded or limit_exceeded: the model is unchanged, and the job can
  ///         be swapped in later.
  Result<TearReport> swap_in(TornModel& model, ChangeRecord* change = nullptr) const;

  /// Whether both refer to the same job.
  bool operator==(const OperationJob&) const = default;

 private:
  explicit OperationJob(std::shared_ptr<tear::OperationTask> task);
  static Result<std::shared_ptr<tear::OperationTask>> make_task(TornModel& model,
                                                                const Operation& operation,
                                                                Observer observer);
  std::shared_ptr<tear::OperationTask> task_;
};

}  // namespace sunder
