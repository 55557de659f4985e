#include "bench/weights/weights_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <set>

#include "bench/harness/measure.h"
#include "bench/weights/bounded_refit_time.h"
#include "bench/weights/exhaustive_refit.h"
#include "bench/weights/refit_rigs.h"
#include "bench/weights/weights_times.h"
#include "support/machine/random.h"

namespace sunder::bench {
namespace {

constexpr std::size_t kSolverPoses = 16;
constexpr std::size_t kExhaustivePoints = 60;
constexpr std::size_t kExhaustiveBones = 8;
/// Smaller errors, as fractions of the diagonal, are rounding: positions are stored in float.
constexpr double kNothing = 1e-7;

std::vector<WeightOptions> all_options() {
  std::vector<WeightOptions> all;
  for (const WeightPolicy policy :
       {WeightPolicy::barycentric, WeightPolicy::pose_exact, WeightPolicy::refit})
    for (const std::uint32_t maximum : {4u, 8u, 0u}) all.push_back({policy, maximum});
  all.push_back({WeightPolicy::exact, 0});
  return all;
}

/// Over a seeded sample of the points that few enough bones move.
double measure_vs_exhaustive(const WeightsModel& model, const Poses& poses) {
  const PointsToWeigh points(model, poses.fit);
  std::vector<std::size_t> some(points.size());
  std::iota(some.begin(), some.end(), 0u);
  std::erase_if(
      some, [&](std::size_t i) { return points.point(i).exact.terms().size() > kExhaustiveBones; });
  test::Random random(3);
  for (std::size_t i = 0; i + 1 < some.size(); ++i)
    std::swap(some[i], some[i + random.index(static_cast<std::uint32_t>(some.size() - i))]);
  some.resize(std::min(some.size(), kExhaustivePoints));
  PointRefit refit;
  double of_fits = 0, of_references = 0;
  for (const std::size_t i : some) {
    const TornPoint& point = points.point(i);
    const ExhaustiveRefit reference(point.exact, point.position(), points.palettes(i));
    const PointRefit::Fit fit = refit.fit(points.to_refit(i, 4), {4, true}, points.moments(i));
    const double of_fit = reference.mean_square(fit.influences, fit.position);
    of_fits += of_fit;
    of_references += std::min(of_fit, reference.least_mean_square(4, fit.position));
  }
  const double nothing = kNothing * model.diagonal;
  return of_references > nothing * nothing * static_cast<double>(some.size())
             ? std::sqrt(of_fits / of_references)
             : 1.0;
}

/// A column per bone of the fit: the error if that bone had all the weight, so that the target is
/// zero.
WeightProblem problem_of(const PointsToWeigh& points, std::size_t i,
                         std::span<const Influence> influences, double diagonal) {
  WeightProblem problem;
  const auto bones = static_cast<Eigen::Index>(influences.size());
  problem.matrix.resize(WeightProblem::kRows, bones);
  problem.matrix.setZero();
  problem.target.setZero();
  problem.start.resize(bones);
  const TornPoint& point = points.point(i);
  const auto palettes = points.palettes(i);
  for (Eigen::Index bone = 0; bone < bones; ++bone) {
    const std::uint32_t slot = influences[static_cast<std::size_t>(bone)].slot;
    for (std::size_t pose = 0; pose < palettes.size(); ++pose)
      problem.matrix.block<3, 1>(3 * static_cast<Eigen::Index>(pose), bone) =
          (palettes[pose][slot] * point.position() - point.exact.posed(palettes[pose])) / diagonal;
    problem.start[bone] = 1e-3;
    for (const auto& term : point.exact.terms())
      if (term.slot == slot) problem.start[bone] = std::max(1e-3, term.q.w());
  }
  problem.start /= problem.start.sum();
  return problem;
}

SolverInput measure_solver(const WeightsModel& model, const PointsToWeigh& points) {
  constexpr PointRefit::Options kWeightsAlone = {4, false};
  SolverInput input;
  PointRefit refit;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointRefit::Fit fit = refit.fit(points.to_refit(i, 4), kWeightsAlone, points.moments(i));
    if (fit.influences.size() < 2) continue;
    const WeightProblem problem = problem_of(points, i, fit.influences, model.diagonal);
    Eigen::VectorXd weights(problem.matrix.cols());
    for (std::size_t k = 0; k < fit.influences.size(); ++k)
      weights[static_cast<Eigen::Index>(k)] = static_cast<double>(fit.influences[k].weight);
    input.mean_squares.push_back((problem.matrix * (weights / weights.sum())).squaredNorm() /
                                 kSolverPoses);
    input.problems.push_back(problem);
    numbers.push_back(i);
  }
  if (!numbers.empty()) input.microseconds = points.fit_microseconds(kWeightsAlone, numbers);
  return input;
}

/// The median; for an even count, the mean of the two in the middle.
double middle_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

/// Nothing if there is nothing to gain, because one bone moves all points.
std::optional<double> gain(double barycentric, double refit) {
  if (barycentric <= kNothing) return std::nullopt;
  return barycentric / std::max(refit, kNothing);
}

}  // namespace

const PolicyRow& ModelFigures::row(const WeightOptions& options) const {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const PolicyRow& row) { return row.options == options; });
  if (found == rows.end()) std::abort();
  return *found;
}

std::optional<double> ModelFigures::gain_clips() const {
  const auto &barycentric = row({WeightPolicy::barycentric, 4}).errors.clips,
             &refit = row({WeightPolicy::refit, 4}).errors.clips;
  if (!barycentric || !refit) return std::nullopt;
  return gain(barycentric->held_out.rms, refit->held_out.rms);
}

std::optional<double> ModelFigures::gain_range_of_motion() const {
  return gain(row({WeightPolicy::barycentric, 4}).errors.range_of_motion.held_out.rms,
              row({WeightPolicy::refit, 4}).errors.range_of_motion.held_out.rms);
}

ModelFigures measure_model(WeightsModel& model) {
  ModelFigures figures;
  figures.name = model.name;
  figures.points = model.point_count();
  figures.diagonal = model.diagonal;
  const PointsToWeigh points(model, model.usual_poses().fit);
  for (const WeightOptions& options : all_options())
    figures.rows.push_back({options, points.microseconds(options), measure_policy(model, options)});
  figures.barycentric_us = figures.row({WeightPolicy::barycentric, 4}).microseconds;
  const PointsToWeigh over_few(model, some_of(model.usual_poses().fit, kSolverPoses));
  std::vector<std::size_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  figures.refit_us = over_few.fit_microseconds({4, false}, all);
  figures.solvers = measure_solver(model, over_few);
  figures.runtime_error = largest_runtime_error(model);
  figures.vs_exhaustive = measure_vs_exhaustive(model, model.range_of_motion);
  if (model.clips)
    figures.vs_exhaustive =
        std::max(figures.vs_exhaustive, measure_vs_exhaustive(model, *model.clips));
  return figures;
}

RigFigures measure_rigs(const std::vector<WeightsModel>& models) {
  RigFigures figures;
  std::vector<double> ratios;
  for (const WeightsModel& model : models) {
    const BoundedRefitTime time = measure_bounded_refit(model);
    std::fprintf(stderr, "%s: fits within bounds over %zu groups %.2f us, without %.2f us\n",
                 model.name.c_str(), time.groups, time.bounded, time.plain);
    ratios.push_back(time.bounded / time.plain);
  }
  figures.vs_plain_time = middle_of(ratios);
  figures.rigs = measure_refit_rigs();
  return figures;
}

Summary summarise(const std::vector<ModelFigures>& models, const RigFigures& rigs) {
  Summary summary;
  summary.refit_gain_least_group = 1e9;
  for (const test::RefitGains& rig : rigs.rigs) {
    summary.refit_gain_least_group = std::min(summary.refit_gain_least_group, rig.least());
    summary.refit_groups += rig.groups.size();
    summary.refit_groups_lost += rig.lost();
  }
  std::set<std::string> names;
  for (const test::RefitGains& rig : rigs.rigs) names.insert(rig.name);
  summary.refit_rigs = names.size();
  summary.refit_vs_today_time = rigs.vs_plain_time;
  std::vector<double> of_clips, of_motion;
  double points = 0;
  for (const ModelFigures& model : models) {
    summary.exact_max_rel = std::max(summary.exact_max_rel, model.runtime_error);
    summary.refit_vs_exhaustive = std::max(summary.refit_vs_exhaustive, model.vs_exhaustive);
    for (const PolicyRow& row : model.rows)
      if (row.options.policy == WeightPolicy::pose_exact)
        summary.pose_exact_pop_rel = std::max(summary.pose_exact_pop_rel, row.errors.pop);
    if (const auto gain = model.gain_clips()) of_clips.push_back(*gain);
    if (const auto gain = model.gain_range_of_motion()) of_motion.push_back(*gain);
    summary.refit_us += model.refit_us * static_cast<double>(model.points);
    summary.barycentric_us += model.barycentric_us * static_cast<double>(model.points);
    points += static_cast<double>(model.points);
  }
  summary.refit_us /= points;
  summary.barycentric_us /= points;
  if (!of_clips.empty()) summary.refit_gain_clips_median = middle_of(of_clips);
  summary.refit_gain_rom_median = middle_of(of_motion);
  of_motion.insert(of_motion.end(), of_clips.begin(), of_clips.end());
  if (!of_motion.empty())
    summary.refit_gain_min = *std::min_element(of_motion.begin(), of_motion.end());
  return summary;
}

}  // namespace sunder::bench
