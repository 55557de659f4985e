#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>

namespace sunder {

namespace tear {
struct RefitTask;
}

/// A refit of the weights of torn points that runs in the background:
///
///   auto job = RefitJob::create(model, wanted);           // this frame
///   std::thread worker([job] { job->run(); });            // or the host's job system
///   if (job->poll() == RefitJob::State::done) job->swap_in(model, &change);  // some later frame
///
/// The model may be torn in the meantime. Undoing an operation whose points are being fitted
/// cancels the job. Copies refer to the same job. run(), poll() and cancel() may be called from any
/// thread; create() and swap_in() only from the thread that uses the model.
class SUNDER_API RefitJob {
 public:
  enum class State : std::uint8_t { waiting, running, done, failed, cancelled, swapped_in };

  /// Copies the input of the fit. @param wanted  its policy must be `refit`.
  /// @return as TornModel::reweigh(). O(vertices appended since the first of the operations + bones
  /// x given poses), allocates.
  static Result<RefitJob> create(TornModel& model, const WeightsOperation& wanted);

  /// Runs the fit. Call it once, on any thread; it does not access the model. Deterministic: the
  /// result does not depend on when and where it runs.
  void run() const;
  /// The current state.
  [[nodiscard]] State poll() const;
  void cancel() const;
  /// The cause, if poll() returns `failed`.
  [[nodiscard]] const Status& failure() const;

  /// Assigns the fitted weights, as TornModel::reweigh() would. O(vertices appended since the first
  /// of the operations).
  /// @return invalid_argument for a job that is not done, was cancelled, or belongs to another
  /// model.
  Result<WeightReport> swap_in(TornModel& model, ChangeRecord* change = nullptr) const;

 private:
  explicit RefitJob(std::shared_ptr<tear::RefitTask> task);
  std::shared_ptr<tear::RefitTask> task_;
};

}  // namespace sunder
