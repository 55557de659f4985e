#pragma once

#include <sunder/tear/torn_model.h>

#include <optional>
#include <string>
#include <vector>

#include "bench/stress/case_report.h"
#include "support/machine/random.h"

namespace sunder::stress {

/// A model that is torn, and its laws after each operation. Violations go into the report of the
/// case.
class TornSubject {
 public:
  TornSubject(Character character, CaseReport& report, const TornCapacity& capacity = {});

  /// Performs an operation whose pose is a ModelPose. An error that is documented for this input
  /// counts as refused; the model must then be as before.
  void operate(const Operation& operation);
  /// The same, blade by blade.
  void tear_in_steps(const TearOperation& tear);
  /// Assigns new weights to what earlier operations made.
  void reweigh(const WeightsOperation& wanted);
  /// Undoes and redoes in bursts, then undoes everything, redoes it, and replays the history on the
  /// source: each state must come back bit for bit.
  void finish(test::Random& random);

  /// Laws are checked after every `n`-th operation only: for long sequences.
  void check_every(std::uint32_t n) { check_every_ = n; }
  /// Errors that are accepted besides invalid_argument and not_found.
  void accept(StatusCode code) { accepted_.push_back(code); }

  [[nodiscard]] TornModel& model() { return *model_; }
  [[nodiscard]] CaseReport& report() { return report_; }
  [[nodiscard]] bool has_failed() const { return !report_.violations.empty(); }

 private:
  void note(const Status& status, const ChangeRecord& change);
  void check(const ChangeRecord& change);
  void expect_digest(const char* law, std::size_t done);
  void burst(test::Random& random);

  CaseReport& report_;
  std::optional<TornModel> model_;
  bool is_clear_ = false;
  std::uint32_t check_every_ = 1, since_check_ = 0;
  std::vector<StatusCode> accepted_ = {StatusCode::invalid_argument, StatusCode::not_found};
  std::vector<std::uint64_t> digests_;  ///< After none, one, two … operations.
};

/// Deviation of weights from a sum of one, drift of the area, angles and faces of a model.
void measure(const TornModel& model, CaseReport& report);

}  // namespace sunder::stress
