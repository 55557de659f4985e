#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/align_stroke.h"
#include "pipeline/plan/check_inputs.h"
#include "pipeline/plan/plan_setup.h"
#include "pipeline/plan/stroke_pace.h"
#include "pipeline/plan/target_path.h"

namespace sunder {
namespace plan {
namespace {

constexpr std::size_t kCurveSteps =
    241;  ///< Even places of the curve that blades are aligned with.
/// Errors for which a mark is 0.
constexpr double kFarBeside = 5;  ///< Tolerances. What is farther away does not cover the curve.
constexpr double kFarAngle = std::numbers::pi / 4;
constexpr double kFarSpeed = 4;    ///< Times as fast, or as slow.
constexpr double kFarLogJerk = 4;  ///< Below the wanted one.
/// Shares of the marks in the whole one, which is what they give times what is covered.
constexpr double kShareOfPlace = 0.35, kShareOfDepth = 0.25, kShareOfAngle = 0.1,
                 kShareOfSpeed = 0.15, kShareOfSmoothness = 0.15;

Status check_performed(const TearOperation& performed, std::span<const double> times) {
  const std::size_t count = performed.stroke.size();
  if (count < 2)
    return Status::failure(StatusCode::empty_input, kNone, "the stroke has %zu blades; expected 2",
                           count);
  if (!times.empty() && times.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "there are %zu times; the stroke has %zu blades", times.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Blade& blade = performed.stroke[i];
    if (!blade.base.allFinite() || !blade.tip.allFinite() ||
        (!times.empty() && !std::isfinite(times[i])))
      return Status::failure(StatusCode::non_finite_value, i, "blade %u is not finite", i);
    if (!((blade.base - blade.tip).norm() > 0))
      return Status::failure(StatusCode::invalid_argument, i, "blade %u has no length", i);
    if (i > 0 && !times.empty() && !(times[i] > times[i - 1]))
      return Status::failure(StatusCode::invalid_argument, i,
                             "blade %u is at %g s, not after the one before, at %g s", i, times[i],
                             times[i - 1]);
  }
  std::uint32_t before = 0;
  for (const TearOperation::PoseChange& change : performed.pose_changes) {
    if (change.blade <= before || change.blade >= count)
      return Status::failure(StatusCode::invalid_argument, change.blade,
                             "a pose change is at blade %u; blades must ascend, from 1 to %zu",
                             change.blade, count - 1);
    before = change.blade;
  }
  return {};
}

/// A blade that crosses the surface.
struct Entry {
  std::size_t blade = 0;
  Vec3d place = Vec3d::Zero();   ///< On the surface.
  Vec3d handle = Vec3d::Zero();  ///< From tip to base, unit length.
  double depth = 0;              ///< Of the tip.
  double share = 0;              ///< Of the curve; not descending: from its end if backwards.
  double beside = 0;             ///< Distance from the curve.
  double way = 0;                ///< Half of that from the entry before to the one after.
  Vec3d ideal = Vec3d::Zero();   ///< Where it should be, on the curve.
};

/// Means are weighted by ways.
class ErrorSum {
 public:
  void add(double error, double weight) {
    of_.most = std::max(of_.most, error);
    sum_ += weight * error;
    weights_ += weight;
  }
  [[nodiscard]] StrokeScore::Error error() const {
    return {of_.most, weights_ > 0 ? sum_ / weights_ : 0};
  }

 private:
  StrokeScore::Error of_;
  double sum_ = 0, weights_ = 0;
};

double mark(double error, double far) { return 100 * std::clamp(1 - error / far, 0.0, 1.0); }

/// One score, step by step.
class Scorer {
 public:
  Scorer(const std::shared_ptr<const Character>& character, const PlanTiming& timing,
         const TearOperation& performed, std::span<const double> times)
      : character_(character), timing_(timing), performed_(performed), times_(times) {}

  Result<StrokeScore> run(const WoundTarget& target, double tolerance) {
    const Result<ModelPose> pose = make_pose(*character_, timing_.pose);
    if (!pose) return pose.error();
    const Result<TargetPath> path = TargetPath::create(character_, target, *pose);
    if (!path) return path.error();
    score_.curve_length = path->length();
    score_.tolerance = tolerance > 0 ? tolerance : usual_tolerance(*character_, *path, *pose);
    if (const Status status = find_entries(*path); !status) return status;
    score_.blades = entries_.size();
    if (entries_.empty()) return score_;
    align(path->is_closed());
    if (const Status status = measure(*path); !status) return status;
    cover(path->is_closed());
    if (!times_.empty()) judge_pace(path->length());
    give_marks();
    return score_;
  }

 private:
  /// Calls `visit` with each blade's index and, where the pose changes there, its pose.
  template <typename Visit>
  Status visit_blades(const Visit& visit) const {
    auto change = performed_.pose_changes.begin();
    Result<ModelPose> pose = make_pose(*character_, performed_.pose);
    for (std::size_t i = 0; i < performed_.stroke.size(); ++i) {
      const bool is_changed = change != performed_.pose_changes.end() && change->blade == i;
      if (is_changed) pose = make_pose(*character_, (change++)->pose);
      if (!pose) return pose.error();
      if (const Status status = visit(i, i == 0 || is_changed ? &*pose : nullptr); !status)
        return status;
    }
    return {};
  }

  /// The even places of the curve in a pose.
  static std::vector<TargetSample> even_samples(const TargetPath& path, const PosedPath& posed) {
    std::vector<TargetSample> samples(kCurveSteps);
    for (std::size_t i = 0; i < kCurveSteps; ++i) {
      samples[i].share = static_cast<double>(i) / (kCurveSteps - 1);
      path.sample(posed, 0, samples[i]);
    }
    return samples;
  }

  Status find_entries(const TargetPath& path) {
    const Result<TornModel> model = TornModel::create(character_);
    if (!model) return model.error();
    Result<SurfaceQuery> query = SurfaceQuery::create(*model);
    if (!query) return query.error();
    std::vector<TargetSample> samples;
    std::vector<SurfaceContact> contacts;
    return visit_blades([&](std::size_t i, const ModelPose* pose) -> Status {
      if (pose != nullptr) {
        PosedPath posed;
        if (const Status status = query->set_pose(*pose); !status) return status;
        if (const Status status = path.pose(*pose, posed); !status) return status;
        samples = even_samples(path, posed);
      }
      if (const Status status = query->find_blade_contacts(performed_.stroke[i], contacts); !status)
        return status;
      add_entry(i, contacts, samples);
      return {};
    });
  }

  /// Of the places where a blade enters the surface, the one that is nearest to the curve.
  void add_entry(std::size_t blade, const std::vector<SurfaceContact>& contacts,
                 const std::vector<TargetSample>& samples) {
    const auto square = [](const SurfaceContact& contact, const TargetSample& sample) {
      return (contact.place - sample.place).squaredNorm();
    };
    const SurfaceContact* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const SurfaceContact& contact : contacts) {
      if (!contact.enters) continue;
      for (const TargetSample& sample : samples) {
        if (square(contact, sample) >= least) continue;
        least = square(contact, sample);
        nearest = &contact;
      }
    }
    if (nearest == nullptr) return;
    const Blade& of = performed_.stroke[blade];
    entries_.push_back({blade, nearest->place, (of.base - of.tip).normalized(), nearest->depth});
    for (const TargetSample& sample : samples)
      squares_.push_back(static_cast<float>(square(*nearest, sample)));
  }

  void align(bool is_closed) {
    AlignedStroke aligned = align_stroke(squares_, kCurveSteps, is_closed);
    steps_ = std::move(aligned.steps);
    score_.is_backwards = aligned.is_backwards;
    for (std::size_t i = 1; i < entries_.size(); ++i) {
      if (!is_next(i)) continue;
      const double half = 0.5 * (entries_[i].place - entries_[i - 1].place).norm();
      entries_[i - 1].way += half;
      entries_[i].way += half;
    }
    // So that a blade that is pushed in at one place counts.
    for (Entry& entry : entries_) entry.way += 1e-9 * score_.curve_length;
  }

  /// Whether an entry is of the blade after that of the entry before.
  [[nodiscard]] bool is_next(std::size_t i) const {
    return entries_[i].blade == entries_[i - 1].blade + 1;
  }

  /// Share of the curve from its begin.
  [[nodiscard]] double share_on_curve(double share) const {
    share = share > 1 ? share - 1 : share;
    return score_.is_backwards ? 1 - share : share;
  }

  Status measure(const TargetPath& path) {
    ErrorSum place, deep, shallow, wanted, angle;
    PosedPath posed;
    std::vector<TargetSample> samples;
    std::size_t next = 0;
    const Status status = visit_blades([&](std::size_t i, const ModelPose* pose) -> Status {
      if (pose != nullptr) {
        if (const Status posing = path.pose(*pose, posed); !posing) return posing;
        samples = even_samples(path, posed);
      }
      if (next == entries_.size() || entries_[next].blade != i) return {};
      Entry& entry = entries_[next];
      find_share(samples, next, path.is_closed());
      TargetSample sample;
      sample.share = share_on_curve(entry.share);
      path.sample(posed, 0, sample);
      if (score_.is_backwards)
        sample.handle = 2 * sample.handle.dot(sample.normal) * sample.normal - sample.handle;
      entry.ideal = sample.place;
      place.add(entry.beside, entry.way);
      angle.add(std::acos(std::clamp(entry.handle.dot(sample.handle), -1.0, 1.0)), entry.way);
      if (sample.is_full) {
        deep.add(std::max(entry.depth - sample.depth, 0.0), entry.way);
        shallow.add(std::max(sample.depth - entry.depth, 0.0), entry.way);
        wanted.add(sample.depth, entry.way);
      }
      ++next;
      return {};
    });
    score_.place = place.error();
    score_.too_deep = deep.error();
    score_.too_shallow = shallow.error();
    score_.wanted_depth = wanted.error().mean;
    score_.angle = angle.error();
    return status;
  }

  /// Writes the share of an entry, beside its step, and its distance from the curve.
  void find_share(const std::vector<TargetSample>& samples, std::size_t i, bool is_closed) {
    Entry& entry = entries_[i];
    const std::size_t last = is_closed ? 2 * (kCurveSteps - 1) : kCurveSteps - 1;
    entry.beside = std::numeric_limits<double>::infinity();
    const auto at = [&](std::size_t step) -> const Vec3d& {
      const std::size_t on = step < kCurveSteps ? step : step - (kCurveSteps - 1);
      return samples[score_.is_backwards ? kCurveSteps - 1 - on : on].place;
    };
    for (std::size_t step = std::max<std::size_t>(steps_[i], 1) - 1;
         step < std::min(steps_[i] + 1, last); ++step) {
      const Vec3d along = at(step + 1) - at(step);
      const double square = along.squaredNorm();
      const double part =
          square > 0 ? std::clamp((entry.place - at(step)).dot(along) / square, 0.0, 1.0) : 0;
      const double beside = (at(step) + part * along - entry.place).norm();
      if (beside >= entry.beside) continue;
      entry.beside = beside;
      entry.share = (static_cast<double>(step) + part) / (kCurveSteps - 1);
    }
    if (i > 0) entry.share = std::max(entry.share, entries_[i - 1].share);
  }

  void cover(bool is_closed) {
    double sum = 0;
    const double most = kFarBeside * score_.tolerance;
    for (std::size_t i = 1; i < entries_.size(); ++i)
      if (is_next(i) && entries_[i].beside <= most && entries_[i - 1].beside <= most)
        sum += entries_[i].share - entries_[i - 1].share;
    score_.covered = is_closed ? std::min(sum, 1.0) : sum;
  }

  void judge_pace(double length) {
    std::vector<PacedBlade> blades;
    for (const Entry& entry : entries_)
      blades.push_back({times_[entry.blade], entry.share, entry.ideal});
    // Of the blade, where it is at the surface on average: what is above and below it swings with
    // the surface's direction.
    double from_tip = 0, way = 0;
    for (const Entry& entry : entries_) {
      from_tip += entry.way * (entry.place - performed_.stroke[entry.blade].tip).norm();
      way += entry.way;
    }
    std::vector<Vec3d> places;
    for (const Blade& blade : performed_.stroke)
      places.push_back(blade.tip + from_tip / way * (blade.base - blade.tip).normalized());
    score_.pace = pace_of(blades, places, times_, length, length * Timeline(timing_).even_speed());
  }

  void give_marks() {
    StrokeScore::Marks& marks = score_.marks;
    marks.covered = 100 * score_.covered;
    marks.place = mark(score_.place.mean, kFarBeside * score_.tolerance);
    if (score_.wanted_depth > 0)
      marks.depth = mark(score_.too_deep.mean + score_.too_shallow.mean, score_.wanted_depth);
    marks.angle = mark(score_.angle.mean, kFarAngle);
    if (score_.pace) mark_pace(*score_.pace);
    double sum =
        kShareOfPlace * marks.place + kShareOfDepth * marks.depth + kShareOfAngle * marks.angle;
    double of = kShareOfPlace + kShareOfDepth + kShareOfAngle;
    const auto add = [&](const std::optional<double>& part, double share) {
      if (!part) return;
      sum += share * *part;
      of += share;
    };
    add(marks.speed, kShareOfSpeed);
    add(marks.smoothness, kShareOfSmoothness);
    marks.whole = score_.covered * sum / of;
  }

  void mark_pace(const StrokePace& pace) {
    const double ratio = pace.speed / pace.wanted_speed;
    const bool may_be_slow = timing_.may_take_longer && ratio < 1;
    const double off = may_be_slow || !(ratio > 0) ? 0 : std::abs(std::log(ratio));
    score_.marks.speed = mark(pace.unevenness, 1) * mark(off, std::log(kFarSpeed)) / 100;
    if (pace.log_jerk)
      score_.marks.smoothness = mark(*pace.wanted_log_jerk - *pace.log_jerk, kFarLogJerk);
  }

  const std::shared_ptr<const Character>& character_;
  const PlanTiming& timing_;
  const TearOperation& performed_;
  std::span<const double> times_;
  std::vector<Entry> entries_;
  std::vector<float> squares_;  ///< Per entry and even place of the curve, their distance squared.
  std::vector<std::size_t> steps_;
  StrokeScore score_;
};

}  // namespace
}  // namespace plan

Result<StrokeScore> score_stroke(const std::shared_ptr<const Character>& character,
                                 const WoundTarget& target, const PlanTiming& timing,
                                 const TearOperation& performed, std::span<const double> times,
                                 double tolerance) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  PlanOptions options;
  options.tolerance = tolerance;
  if (const Status status = plan::check_timing(timing, options); !status) return status;
  if (const Status status = plan::check_performed(performed, times); !status) return status;
  return or_out_of_memory([&]() -> Result<StrokeScore> {
    if (const Status status = validate_character(*character); !status) return status;
    return plan::Scorer(character, timing, performed, times).run(target, tolerance);
  });
}

}  // namespace sunder
