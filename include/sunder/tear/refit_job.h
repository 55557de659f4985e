#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>

namespace sunder {

namespace tear {
struct RefitWork;
}

/// A refit of the weights of torn points that runs beside the frame:
///
///   auto job = RefitJob::create(model, wanted);           // this frame
///   std::thread worker([job] { job->run(); });            // or the host's job system
///   if (job->poll() == RefitJob::State::done) job->swap_in(model, &change);  // some later frame
///
/// The model may be torn on meanwhile. Undoing an operation whose points are being fitted cancels
/// the job. Copies are the same job.
class SUNDER_API RefitJob {
 public:
  enum class State : std::uint8_t { waiting, running, done, failed, cancelled, swapped_in };

  /// Copies what the fit takes. @param wanted  its policy is `refit`.
  /// @return as TornModel::reweigh(). O(vertices appended since the first of the operations + bones
  /// x held poses).
  static Result<RefitJob> create(TornModel& model, const WeightsOperation& wanted);

  /// Fits. To be called once, on any thread; does not touch the model. Deterministic: weights do
  /// not depend on when, where or beside what it runs.
  void run() const;
  /// To be called from any thread.
  [[nodiscard]] State poll() const;
  void cancel() const;
  /// Why it failed. Only once poll() says so.
  [[nodiscard]] const Status& failure() const;

  /// Gives the points their new weights: TornModel::reweigh() with the work done. O(vertices
  /// appended since the first of the operations).
  /// @return invalid_argument for a job that is not done, was cancelled, or is of another model.
  Result<WeightReport> swap_in(TornModel& model, ChangeRecord* change = nullptr) const;

 private:
  explicit RefitJob(std::shared_ptr<tear::RefitWork> work);
  std::shared_ptr<tear::RefitWork> work_;
};

}  // namespace sunder
