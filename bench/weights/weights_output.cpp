#include "bench/weights/weights_output.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"

namespace sunder::bench {
namespace {

std::string number_of(std::uint32_t maximum) {
  return maximum == 0 ? "all" : std::to_string(maximum);
}

/// The median over models of the value that `figure` reads from one row of each.
void print_median(const std::vector<ModelFigures>& models, std::size_t row,
                  const std::function<std::optional<double>(const PolicyRow&)>& figure) {
  std::vector<double> values;
  for (const ModelFigures& model : models)
    if (const auto value = figure(model.rows[row])) values.push_back(*value);
  if (values.empty())
    std::printf(" – |");
  else
    std::printf(" %.2g |", median(values));
}

using Over = PolicyErrors::OverPoses;

std::optional<Over> over_clips(const PolicyRow& row) { return row.errors.clips; }
std::optional<Over> over_motion(const PolicyRow& row) { return row.errors.range_of_motion; }

void print_policies(const std::vector<ModelFigures>& models) {
  std::printf(
      "Medians over %zu models; errors in per cent of the diagonal, of clips and of a range of "
      "motion (ROM).\n\n"
      "| policy | K | µs per point | clips: fit, RMS | held out, RMS | 95 %% | max | ROM: fit, RMS "
      "| "
      "held out, RMS | 95 %% | max | "
      "pop | fell "
      "back |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      models.size());
  for (std::size_t i = 0; i < models.front().rows.size(); ++i) {
    const WeightOptions& options = models.front().rows[i].options;
    std::printf("| %s | %s |", weight_policy_name(options.policy),
                number_of(options.maximum_influences).c_str());
    print_median(models, i, [](const PolicyRow& row) { return row.microseconds; });
    for (const auto& over : {over_clips, over_motion}) {
      const auto print = [&](double (*figure)(const Over&)) {
        print_median(models, i, [&](const PolicyRow& row) {
          const auto errors = over(row);
          return errors ? std::optional(100 * figure(*errors)) : std::nullopt;
        });
      };
      print([](const Over& errors) { return errors.fit.rms; });
      print([](const Over& errors) { return errors.held_out.rms; });
      print([](const Over& errors) { return errors.held_out.percentile95; });
      print([](const Over& errors) { return errors.held_out.maximum; });
    }
    print_median(models, i, [](const PolicyRow& row) { return 100 * row.errors.pop; });
    std::uint32_t fell_back = 0;
    for (const ModelFigures& model : models) fell_back += model.rows[i].errors.ill_conditioned;
    std::printf(" %s |\n", options.policy == WeightPolicy::pose_exact
                               ? std::to_string(fell_back).c_str()
                               : "");
  }
}

void print_gain(std::optional<double> gain) {
  if (gain)
    std::printf(" %.2f |", *gain);
  else
    std::printf(" – |");
}

void print_models(const std::vector<ModelFigures>& models) {
  std::printf(
      "\nBy model, K = 4: gain is the RMS of barycentric weights / that of the refit, on "
      "held-out poses.\n\n"
      "| model | points | gain, clips | gain, ROM | refit / exhaustive search | exact, in float, "
      "max of diagonal | barycentric, "
      "µs | refit of "
      "weights only, µs |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const ModelFigures& model : models) {
    std::printf("| %s | %zu |", model.name.c_str(), model.points);
    print_gain(model.gain_clips());
    print_gain(model.gain_range_of_motion());
    std::printf(" %.4f | %.1e | %.3f | %.2f |\n", model.vs_exhaustive, model.runtime_error,
                model.barycentric_us, model.refit_us);
  }
}

using Gain = double test::GroupGain::*;

/// Of some rigs and seeds: the median of a kind of group, and the least gain of any group of it.
void print_kind(const std::vector<const test::RefitGains*>& rigs, test::GroupGain::Kind kind,
                Gain gain = &test::GroupGain::gain) {
  std::vector<double> medians;
  double least = 1e9;
  for (const test::RefitGains* rig : rigs) {
    if (const double middle = rig->median(kind, gain); middle > 0) medians.push_back(middle);
    for (const test::GroupGain& group : rig->groups)
      if (group.kind == kind) least = std::min(least, group.*gain);
  }
  if (medians.empty())
    std::printf(" – |");
  else
    std::printf(" %.2f (%.3f) |", median(medians), least);
}

constexpr test::GroupGain::Kind kKinds[] = {
    test::GroupGain::Kind::clip, test::GroupGain::Kind::rest, test::GroupGain::Kind::operation,
    test::GroupGain::Kind::range_of_motion, test::GroupGain::Kind::random};

void print_rigs_row(const char* name, const std::vector<const test::RefitGains*>& rigs) {
  if (rigs.empty()) return;
  std::size_t points = 0, refitted = 0;
  std::vector<double> microseconds;
  for (const test::RefitGains* rig : rigs) {
    points += rig->points;
    refitted += rig->refitted;
    microseconds.push_back(rig->microseconds);
  }
  std::printf("| %s | %zu | %zu |", name, points, refitted);
  for (const test::GroupGain::Kind kind : kKinds) print_kind(rigs, kind);
  std::printf(" %.0f |\n", median(microseconds));
}

/// The gains of all rigs by statistic.
void print_statistics(const std::vector<const test::RefitGains*>& rigs) {
  std::printf(
      "\nThe same of all rigs by statistic of the error over points and poses of a group.\n\n"
      "| statistic | each clip | rest | pose of the tear | range of motion | random poses |\n"
      "|---|---|---|---|---|---|\n");
  for (const auto& [name, gain] :
       {std::pair("root mean square", &test::GroupGain::gain),
        std::pair("95th percentile", &test::GroupGain::gain_of_percentile95),
        std::pair("maximum", &test::GroupGain::gain_of_maximum)}) {
    std::printf("| %s |", name);
    for (const test::GroupGain::Kind kind : kKinds) print_kind(rigs, kind, gain);
    std::printf("\n");
  }
}

void print_rigs(const RigFigures& figures) {
  std::printf(
      "\nRigs that refits were not tuned on, four tears each, three seeds, K = 4: the gain in "
      "poses that were not fitted, median and in parentheses the least of all groups.\n\n"
      "| rig | points | fitted | each clip | rest | pose of the tear | range of motion | random "
      "poses | µs per point, poses included |\n|---|---|---|---|---|---|---|---|---|\n");
  std::vector<const test::RefitGains*> random, all, of_file;
  std::string name;
  for (const test::RefitGains& rig : figures.rigs) {
    all.push_back(&rig);
    if (rig.name.starts_with("random rig")) {
      random.push_back(&rig);
      continue;
    }
    if (rig.name != name) {
      print_rigs_row(name.c_str(), of_file);
      of_file.clear();
      name = rig.name;
    }
    of_file.push_back(&rig);
  }
  print_rigs_row(name.c_str(), of_file);
  print_rigs_row("random rigs", random);
  print_rigs_row("all", all);
  print_statistics(all);
  std::size_t groups = 0, lost = 0;
  for (const test::RefitGains& rig : figures.rigs) {
    groups += rig.groups.size();
    lost += rig.lost();
  }
  std::printf("\nOf %zu groups %zu lost.\n", groups, lost);
}

void print_lips(const std::vector<LipQuality>& ways) {
  std::printf(
      "\nAlong the lips of four tears per rig, K = 4, in poses of the clips that were not fitted; "
      "medians over the files and 40 random rigs.\n\n"
      "| weights | gain | normal jump, degrees | crack, of the diagonal | µs per point, poses "
      "included |\n|---|---|---|---|---|\n");
  for (const LipQuality& way : ways)
    std::printf("| %s | %.2f | %.2f | %.2g | %.0f |\n", way.name.c_str(), way.gain, way.normal_jump,
                way.crack, way.microseconds);
}

void print_solvers(const std::vector<ModelFigures>& models,
                   const std::vector<SolverFigures>& solvers) {
  double microseconds = 0, problems = 0, sum = 0;
  for (const ModelFigures& model : models) {
    const auto count = static_cast<double>(model.solvers.problems.size());
    microseconds += model.solvers.microseconds * count;
    problems += count;
    for (const double square : model.solvers.mean_squares) sum += square;
  }
  std::printf(
      "\nThe same %.0f convex problems, 16 poses, weights alone. PointRefit chooses up to four of "
      "all bones; the others get "
      "these.\n\n"
      "| solver | µs per problem | RMS / PointRefit's |\n|---|---|---|\n| PointRefit | %.2f | 1 "
      "|\n",
      problems, microseconds / problems);
  for (const SolverFigures& solver : solvers) {
    double of_solver = 0;
    for (const double square : solver.mean_squares) of_solver += square;
    std::printf("| %s | %.2f | %.6f |\n", solver.name, solver.microseconds,
                std::sqrt(of_solver / sum));
  }
}

void add_statistics(JsonObject& object, const std::string& name, const ErrorStatistics& errors,
                    double diagonal) {
  object.add((name + "_percent").c_str(), {{"rms", 100 * errors.rms},
                                           {"percentile95", 100 * errors.percentile95},
                                           {"maximum", 100 * errors.maximum}});
  object.add((name + "_metres").c_str(), {{"rms", diagonal * errors.rms},
                                          {"percentile95", diagonal * errors.percentile95},
                                          {"maximum", diagonal * errors.maximum}});
}

}  // namespace

void print_weights_tables(const std::vector<ModelFigures>& models, const RigFigures& rigs,
                          const std::vector<LipQuality>& lips,
                          const std::vector<SolverFigures>& solvers) {
  print_policies(models);
  print_models(models);
  print_rigs(rigs);
  print_lips(lips);
  print_solvers(models, solvers);
}

void print_weights_summary(const Summary& summary, std::FILE* file) {
  JsonObject object(file);
  object.add("exact_max_rel", summary.exact_max_rel);
  object.add("pose_exact_pop_rel", summary.pose_exact_pop_rel);
  object.add("refit_gain_clips_median", summary.refit_gain_clips_median);
  object.add("refit_gain_rom_median", summary.refit_gain_rom_median);
  object.add("refit_gain_min", summary.refit_gain_min);
  object.add("refit_vs_exhaustive", summary.refit_vs_exhaustive);
  object.add("refit_us", summary.refit_us);
  object.add("barycentric_us", summary.barycentric_us);
  object.add("refit_gain_least_group", summary.refit_gain_least_group);
  object.add("refit_groups", static_cast<double>(summary.refit_groups));
  object.add("refit_groups_lost", static_cast<double>(summary.refit_groups_lost));
  object.add("refit_rigs", static_cast<double>(summary.refit_rigs));
  object.add("refit_vs_today_time", summary.refit_vs_today_time);
  object.end();
}

bool write_weights_json(const std::vector<ModelFigures>& models, const RigFigures& rigs,
                        const char* file) {
  std::FILE* out = std::fopen(file, "w");
  if (out == nullptr) return false;
  std::fprintf(out, "{\"rows\": [\n");
  bool is_first = true;
  for (const ModelFigures& model : models)
    for (const PolicyRow& row : model.rows) {
      if (!is_first) std::fprintf(out, ",");
      is_first = false;
      JsonObject object(out);
      object.add_text("model", model.name);
      object.add_text("policy", weight_policy_name(row.options.policy));
      object.add("maximum_influences", row.options.maximum_influences);
      object.add("microseconds", row.microseconds);
      if (row.errors.clips) {
        add_statistics(object, "clips_fit", row.errors.clips->fit, model.diagonal);
        add_statistics(object, "clips_held_out", row.errors.clips->held_out, model.diagonal);
      }
      add_statistics(object, "range_of_motion_fit", row.errors.range_of_motion.fit, model.diagonal);
      add_statistics(object, "range_of_motion_held_out", row.errors.range_of_motion.held_out,
                     model.diagonal);
      object.add("pop_percent", 100 * row.errors.pop);
      object.add("pop_metres", model.diagonal * row.errors.pop);
      object.add("ill_conditioned", row.errors.ill_conditioned);
      object.end();
    }
  std::fprintf(out, "], \"models\": [\n");
  is_first = true;
  for (const ModelFigures& model : models) {
    if (!is_first) std::fprintf(out, ",");
    is_first = false;
    JsonObject object(out);
    object.add_text("model", model.name);
    object.add("points", static_cast<double>(model.points));
    object.add("diagonal_metres", model.diagonal);
    object.add("exact_max_rel", model.runtime_error);
    object.add("refit_vs_exhaustive", model.vs_exhaustive);
    object.add("refit_gain_clips", model.gain_clips());
    object.add("refit_gain_rom", model.gain_range_of_motion());
    object.add("barycentric_us", model.barycentric_us);
    object.add("refit_us", model.refit_us);
    object.end();
  }
  std::fprintf(out, "], \"summary\": ");
  print_weights_summary(summarise(models, rigs), out);
  std::fprintf(out, "}\n");
  return std::fclose(out) == 0;
}

}  // namespace sunder::bench
