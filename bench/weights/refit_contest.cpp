#include "bench/weights/refit_contest.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "bench/harness/measure.h"
#include "bench/weights/refit_methods.h"
#include "core/internal/ordered.h"
#include "support/models/rigs.h"
#include "tear/model/model_access.h"
#include "tear/weights/refit_surface.h"

namespace sunder::bench {
namespace {

constexpr std::size_t kTears = 4, kInfluences = 4;
constexpr int kHeldOutPoses = 24;  // per clip
/// Smaller errors, as shares of the diagonal, are rounding.
constexpr double kNothing = 2e-7;

template <class T>
T value_or_abort(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().text().data());
    std::abort();
  }
  return std::move(*result);
}

/// A rig without some of its clips, torn in poses of the others, and the points of the tears.
class Contest {
 public:
  Contest(const BendingRig& rig, std::uint64_t seed) : whole_(rig.character), random_(seed) {
    choose_clips();
    if (held_out_.empty()) return;
    model_.emplace(value_or_abort(TornModel::create(source_)));
    for (int attempt = 0; attempt < 60 && tears_ < kTears; ++attempt) {
      const ModelPose pose = pose_of(*source_, random_.index(clip_count()), random_.uniform(0, 1));
      const auto report = model_->tear(pose, test::random_stroke(*source_, pose, random_));
      if (report && report->runs > 0) ++tears_;
      if (report && report->runs == 0) (void)model_->undo();
    }
    if (tears_ > 0) make_task();
  }

  [[nodiscard]] std::size_t points() const { return task_ ? task_->points.size() : 0; }

  /// Fits by every method.
  [[nodiscard]] std::vector<MethodGain> compare() {
    const std::vector<PointSkin> start = skins_of_task();
    const PosedPoints fitted = posed(fit_poses());
    std::vector<PosedPoints> held_out;
    for (const std::uint32_t clip : held_out_) held_out.push_back(posed(clip_poses(clip)));
    const auto& state = tear::ModelAccess::state_of(*model_);
    const auto neighbours =
        tear::find_neighbours(task_->assignment, state.history.done().front()->begin, state.editor);
    const PointsToFit of{task_->points, start, neighbours, fitted, kInfluences};
    const std::function<std::vector<PointSkin>()> methods[] = {
        [&] {
          task_->run();
          return skins_of_task();
        },
        [&] { return fit_in_turns(of, Reduction::by_effect); },
        [&] { return fit_in_turns(of, Reduction::smallest_first); },
        [&] { return fit_differences(of); }};
    std::vector<MethodGain> gains;
    for (const auto& method : methods) {
      std::vector<PointSkin> fits;
      const double seconds = seconds_of([&] { fits = method(); });
      gains.push_back(gain_of(start, fits, fitted, held_out));
      gains.back().seconds = seconds;
    }
    return gains;
  }

 private:
  using Poses = std::vector<std::pair<ModelPose, double>>;

  [[nodiscard]] std::uint32_t clip_count() const {
    return static_cast<std::uint32_t>(source_->clips.size());
  }

  static ModelPose pose_of(const Character& character, std::uint32_t clip, double share) {
    return value_or_abort(make_pose(
        character, ClipPose{clip, share * static_cast<double>(character.clips[clip].duration)}));
  }

  /// Leaves a random half of the clips, which are fitted; the others are held out.
  void choose_clips() {
    std::vector<std::uint32_t> order(whole_->clips.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random_.index(static_cast<std::uint32_t>(i))]);
    auto fitted = std::make_shared<Character>(*whole_);
    fitted->clips.clear();
    for (std::size_t i = 0; i < order.size(); ++i)
      if (2 * i < order.size())
        fitted->clips.push_back(whole_->clips[order[i]]);
      else
        held_out_.push_back(order[i]);
    source_ = std::move(fitted);
  }

  /// As RefitJob does, which keeps its task for itself.
  void make_task() {
    auto& state = tear::ModelAccess::state_of(*model_);
    WeightsOperation wanted;
    wanted.operation_count = static_cast<std::uint32_t>(tears_);
    wanted.weights = {WeightPolicy::refit, kInfluences};
    WeightReport report;
    const auto points = tear::interpolated_points(state.vertices_of(wanted), state.editor);
    auto assignment = tear::compute_weights(points, wanted.weights, {}, state.editor, report);
    const auto& done = state.history.done();
    task_.emplace(source_, wanted, std::move(assignment), done.front()->begin, state.editor);
    for (std::size_t i = 0; i < tears_; ++i)
      task_->add_operation(done[i]->operation, done[i]->serial,
                           state.editor.log.vertex_counts_at(done[i]->begin));
  }

  [[nodiscard]] std::vector<PointSkin> skins_of_task() const {
    std::vector<PointSkin> skins;
    for (std::size_t i = 0; i < task_->points.size(); ++i) {
      const std::span<const Influence> influences = task_->barycentric(i);
      skins.push_back(
          {{influences.begin(), influences.end()},
           Vec3d(task_->assignment.points[i].position.cast<double>()) + task_->points[i].morph});
    }
    return skins;
  }

  [[nodiscard]] Poses fit_poses() const {
    const PoseSet set = value_or_abort(PoseSet::create(source_, {}));
    Poses poses;
    for (std::size_t i = 0; i < set.size(PoseSet::Role::fit); ++i) {
      auto& [pose, weight] = poses.emplace_back();
      if (!set.compute(PoseSet::Role::fit, i, pose)) std::abort();
      weight = set.weight_of(i);
    }
    return poses;
  }

  [[nodiscard]] Poses clip_poses(std::uint32_t clip) const {
    Poses poses;
    for (int i = 0; i < kHeldOutPoses; ++i)
      poses.emplace_back(pose_of(*whole_, clip, (i + 0.5) / kHeldOutPoses), 1.0);
    return poses;
  }

  [[nodiscard]] PosedPoints posed(const Poses& poses) const {
    PosedPoints result;
    for (const auto& [pose, weight] : poses) {
      PosedPoints::Pose& of = result.poses.emplace_back();
      of.weight = weight;
      for (const Skin& skin : source_->skins) {
        auto& palette = of.palettes.emplace_back(skin.bones.size());
        if (!compute_palette(skin, pose, palette)) std::abort();
      }
      for (const tear::RefitTask::Point& point : task_->points)
        of.exact.push_back(point.exact.posed(of.palettes[point.skin]));
    }
    return result;
  }

  /// The root mean square error of some weights over all points.
  [[nodiscard]] double rms(const std::vector<PointSkin>& skins, const PosedPoints& over) const {
    double sum = 0;
    for (std::size_t i = 0; i < skins.size(); ++i)
      sum += mean_square(over, i, task_->points[i].skin, skins[i]);
    return std::sqrt(sum / static_cast<double>(skins.size()));
  }

  [[nodiscard]] MethodGain gain_of(const std::vector<PointSkin>& start,
                                   const std::vector<PointSkin>& fits, const PosedPoints& fitted,
                                   const std::vector<PosedPoints>& held_out) const {
    const double nothing =
        kNothing * test::posed_diagonal(*source_, value_or_abort(rest_pose(*source_)));
    const auto ratio = [&](double before, double after) {
      return std::max(before, nothing) / std::max(after, nothing);
    };
    MethodGain gain;
    gain.fitted = ratio(rms(start, fitted), rms(fits, fitted));
    gain.clips = held_out.size();
    double before = 0, after = 0;
    gain.least_clip = 1e300;
    for (const PosedPoints& clip : held_out) {
      const double of_start = rms(start, clip), of_fits = rms(fits, clip);
      before += of_start * of_start;
      after += of_fits * of_fits;
      gain.least_clip = std::min(gain.least_clip, ratio(of_start, of_fits));
      gain.clips_lost += ratio(of_start, of_fits) < 1 - 1e-9 ? 1 : 0;
    }
    const auto clips = static_cast<double>(held_out.size());
    gain.held_out = ratio(std::sqrt(before / clips), std::sqrt(after / clips));
    return gain;
  }

  std::shared_ptr<const Character> whole_, source_;
  test::Random random_;
  std::vector<std::uint32_t> held_out_;
  std::optional<TornModel> model_;
  std::size_t tears_ = 0;
  std::optional<tear::RefitTask> task_;
};

}  // namespace

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = {"refit", "in turns, largest effects (SSDR)",
                                                 "in turns, smallest weight first",
                                                 "differences of neighbours (Poisson)"};
  return names;
}

MethodGains compare_methods(const BendingRig& rig, std::uint64_t seed) {
  MethodGains result{rig.name, 0, {}};
  Contest contest(rig, seed);
  result.points = contest.points();
  if (result.points > 0) result.methods = contest.compare();
  return result;
}

}  // namespace sunder::bench
