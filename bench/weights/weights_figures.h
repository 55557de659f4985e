#pragma once

#include <string>
#include <vector>

#include "bench/weights/weight_solvers.h"
#include "bench/weights/weights_errors.h"
#include "support/oracles/refit_gains.h"

namespace sunder::bench {

struct PolicyRow {
  WeightOptions options;
  double microseconds = 0;  ///< Per point, over the model's usual poses.
  PolicyErrors errors;
};

/// The convex problems of a model's points (sixteen poses, weights only, at most four): solved by
/// PointRefit, and in a form for other solvers.
struct SolverInput {
  std::vector<WeightProblem>
      /// Points that keep more than one bone: with these bones only, scaled to diagonal 1.
      problems;
  double microseconds = 0;           ///< PointRefit's time per point, with all its bones.
  std::vector<double> mean_squares;  ///< Results of PointRefit, one per problem.
};

struct ModelFigures {
  std::string name;
  std::size_t points = 0;
  double diagonal = 0;  ///< Metres.
  std::vector<PolicyRow> rows;
  double runtime_error = 0;  ///< largest_runtime_error().
  /// Root mean square error of fits, divided by that of ExhaustiveRefit; the larger one of both
  /// pose sets.
  double vs_exhaustive = 0;
  double barycentric_us = 0;  ///< K = 4.
  double refit_us = 0;        ///< PointRefit only: weights only, K = 4, sixteen poses.
  SolverInput solvers;

  [[nodiscard]] const PolicyRow& row(const WeightOptions& options) const;
  [[nodiscard]] std::optional<double> gain_clips() const;
  [[nodiscard]] std::optional<double> gain_range_of_motion() const;
};

/// All measurements of a model.
[[nodiscard]] ModelFigures measure_model(WeightsModel& model);

/// Gains of refits on rigs that they were not tuned on.
struct RigFigures {
  std::vector<test::RefitGains> rigs;  ///< One per rig and seed.
  double vs_plain_time = 0;            ///< Time with bounds / without; median of the models.
};

/// @param models  for the time.
[[nodiscard]] RigFigures measure_rigs(const std::vector<WeightsModel>& models);

struct Summary {
  double exact_max_rel = 0, pose_exact_pop_rel = 0;
  std::optional<double> refit_gain_clips_median;
  double refit_gain_rom_median = 0, refit_gain_min = 0;
  double refit_vs_exhaustive = 0, refit_us = 0, barycentric_us = 0;
  double refit_gain_least_group = 0, refit_vs_today_time = 0;
  std::size_t refit_groups = 0, refit_groups_lost = 0, refit_rigs = 0;
};

[[nodiscard]] Summary summarise(const std::vector<ModelFigures>& models, const RigFigures& rigs);

}  // namespace sunder::bench
