#include "bench/stress/torn_subject.h"

#include <sunder/tear/tear_stroke.h>

#include <algorithm>
#include <cmath>

#include "support/machine/say.h"
#include "support/models/random_operations.h"
#include "support/oracles/face_quality.h"
#include "support/oracles/source_cover.h"
#include "support/oracles/torn_invariants.h"

namespace sunder::stress {
namespace {

using test::say;

void add(const char* law, const std::vector<std::string>& faults, CaseReport& report) {
  for (const std::string& fault : faults) report.violate(law, fault);
}

/// Calls check(change) after each blade of a short stroke.
template <class Check>
Result<TearReport> tear_blade_by_blade(TornModel& model, const TearOperation& tear, Check check) {
  constexpr std::size_t kFewBlades = 64;
  const auto& pose = std::get<ModelPose>(tear.pose);
  auto stroke = TearStroke::create(model, pose, tear.stroke[0], tear.options);
  if (!stroke) return stroke.error();
  ChangeRecord change;
  for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
    if (auto report = stroke->extend(pose, tear.stroke[i], 0.0, &change); !report) return report;
    if (tear.stroke.size() <= kFewBlades) check(change);
  }
  return stroke->end();
}

void measure_weights(const Mesh& mesh, CaseReport& report) {
  for (std::uint32_t v = 0; v < mesh.vertex_count() && !mesh.weights.first.empty(); ++v) {
    double sum = 0;
    const auto influences = mesh.weights.of(v);
    for (const Influence& influence : influences) sum += influence.weight;
    const double error = std::abs(sum - 1);
    report.weight_sum_error = std::max(report.weight_sum_error, error);
    if (error > 2e-7 * static_cast<double>(influences.size()))
      report.violate("weight sums", say("vertex ", v, ": off by ", error));
  }
}

}  // namespace

TornSubject::TornSubject(Character character, CaseReport& report, const TornCapacity& capacity)
    : report_(report) {
  auto model = TornModel::create(std::make_shared<const Character>(std::move(character)), capacity);
  if (!model) {
    report.violate("create", std::string(model.error().text()));
    return;
  }
  model_ = std::move(*model);
  is_clear_ = test::is_clear_of_itself(model_->source());
  digests_.push_back(model_->digest());
}

void TornSubject::operate(const Operation& operation) {
  if (!model_) return;
  ChangeRecord change;
  note(test::play(*model_, operation, &change).error(), change);
}

void TornSubject::tear_in_steps(const TearOperation& tear) {
  if (!model_) return;
  const auto check_lips = [&](const ChangeRecord& change) {
    add("lips", test::broken_lips(*model_, change), report_);
  };
  ChangeRecord none;
  note(tear_blade_by_blade(*model_, tear, check_lips).error(), none);
}

void TornSubject::reweigh(const WeightsOperation& wanted) {
  if (!model_) return;
  ChangeRecord change;
  note(model_->reweigh(wanted, &change).error(), change);
}

void TornSubject::note(const Status& error, const ChangeRecord& change) {
  if (!error) {
    ++report_.refused;
    if (std::find(accepted_.begin(), accepted_.end(), error.code()) == accepted_.end())
      report_.violate("refusal", say(status_name(error.code()), ": ", error.text()));
    expect_digest("failing call changes nothing", digests_.size() - 1);
    return;
  }
  ++report_.operations;
  if (model_->undo_count() + 1 > digests_.size()) digests_.push_back(model_->digest());
  report_.mix(digests_.back());
  if (++since_check_ % check_every_ == 0) check(change);
}

void TornSubject::check(const ChangeRecord& change) {
  add("cover and attributes", test::broken_laws(*model_), report_);
  add("lips", test::broken_lips(*model_, change), report_);
  if (is_clear_) add("manifold surface", test::broken_surface(*model_), report_);
}

void TornSubject::expect_digest(const char* law, std::size_t done) {
  if (model_->undo_count() != done || model_->digest() != digests_[done])
    report_.violate(law, say("state ", done, " of ", digests_.size() - 1, " differs"));
}

void TornSubject::burst(test::Random& random) {
  for (std::uint32_t n = 1 + random.index(5); n > 0 && model_->undo_count() > 0; --n)
    if (!model_->undo()) report_.violate("undo", "refused");
  expect_digest("undo", model_->undo_count());
  for (std::uint32_t n = random.index(6); n > 0 && model_->redo_count() > 0; --n)
    if (!model_->redo()) report_.violate("redo", "refused");
  expect_digest("redo", model_->undo_count());
}

void TornSubject::finish(test::Random& random) {
  if (!model_) return;
  measure(*model_, report_);
  const auto history = model_->history();
  if (!history) return report_.violate("history", std::string(history.error().text()));
  const std::size_t done = digests_.size() - 1;
  for (int n = 0; n < 4; ++n) burst(random);
  while (model_->undo_count() > 0) {
    if (!model_->undo()) return report_.violate("undo", "refused");
    expect_digest("undo", model_->undo_count());
  }
  if (model_->character() != model_->source())
    report_.violate("undo", "the source did not come back");
  while (model_->redo_count() > 0)
    if (!model_->redo()) return report_.violate("redo", "refused");
  expect_digest("redo", done);
  auto again = TornModel::create(std::make_shared<const Character>(model_->source()));
  if (!again) return report_.violate("replay", std::string(again.error().text()));
  for (const Operation& operation : *history)
    if (const auto result = apply_operation(*again, operation); !result)
      return report_.violate("replay", std::string(result.error().text()));
  if (again->digest() != digests_[done]) report_.violate("replay", "another state");
}

void measure(const TornModel& model, CaseReport& report) {
  double whole = 0, parts = 0;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh &torn = model.character().meshes[m], &source = model.source().meshes[m];
    measure_weights(torn, report);
    report.faces += static_cast<std::uint64_t>(
        std::count_if(torn.triangles.begin(), torn.triangles.end(),
                      [](const Triangle& triangle) { return !is_retired(triangle); }));
    const test::Cover cover = test::cover_of(model, m);
    for (std::uint32_t t = 0; t < source.triangle_count(); ++t) {
      if (cover.has_retired[t]) continue;
      const auto& [a, b, c] = source.triangles[t];
      const Vec3d at = source.positions[a].cast<double>();
      const double area = (source.positions[b].cast<double>() - at)
                              .cross(source.positions[c].cast<double>() - at)
                              .norm();
      whole += area;
      parts += area * cover.part[t];
    }
  }
  if (whole > 0) report.area_drift = std::max(report.area_drift, std::abs(parts - whole) / whole);
  const test::FaceQuality quality = test::face_quality(model);
  if (!quality.smallest_angles.empty())
    report.smallest_angle = std::min(report.smallest_angle, quality.angle_at(0.01));
}

}  // namespace sunder::stress
