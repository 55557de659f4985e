// Measures weights of torn points: their cost, and the distance of the points from the untorn
// surface.

#include <cstdio>
#include <cstring>

#include "bench/weights/weights_output.h"
#include "bench/weights/weights_picture.h"
#include "tear/internal/mesh_vertices.h"

namespace sunder::bench {
namespace {

constexpr const char* kHelp =
    "bench_weights [--summary] [--json FILE] [--svg FILE]\n"
    "\n"
    "Tears a procedural rig and six models of ../shared/models five times each, in bent poses, "
    "and\n"
    "weighs the points by every policy with at most 4, 8 and all influences. Errors are those of\n"
    "all points of a model, over the poses of the fit and over held-out poses: of the model's\n"
    "clips, and of a range of motion. 'pop' is the largest error in the pose of\n"
    "the tear; for pose_exact without points whose bones turn too far apart, which are counted in\n"
    "'fell back'.\n"
    "\n"
    "Times are those of functions of `weights`, over all points of a model, the minimum of many\n"
    "runs; corners, matrices and moments are inputs. barycentric: mean_influences() and\n"
    "prune_influences(). The other policies in addition: AnimationPoint; pose_exact\n"
    "solve_bind_position(); refit PointRefit::fit() over the poses of clips, or of the range of\n"
    "motion if there are none.\n"
    "\n"
    "Prints tables. --summary prints one JSON object instead. Relative errors are fractions of "
    "the\n"
    "diagonal at rest; K = 4.\n"
    "  exact_max_rel            largest error of exact points of SkinnedMesh, in float, over all\n"
    "                           poses\n"
    "  pose_exact_pop_rel       largest pop of pose_exact\n"
    "  refit_gain_clips_median  RMS error of barycentric weights / that of the refit, in held-out\n"
    "                           clip poses; median of models, except those whose points follow\n"
    "                           one bone only\n"
    "  refit_gain_rom_median    the same over the range of motion\n"
    "  refit_gain_min           minimum of both, over all models\n"
    "  refit_vs_exhaustive      RMS error of the refit, in the poses of the fit / that of a "
    "search\n"
    "                           over all choices of bones; 60 points per model, of at most 8\n"
    "                           bones; largest of models and both sets of poses\n"
    "  refit_us                 PointRefit::fit() alone, weights only, 16 poses, microseconds per\n"
    "                           point\n"
    "  barycentric_us           mean_influences() and prune_influences(), likewise\n"
    "  refit_gain_least_group   least gain of a refit over any group of poses that were not "
    "fitted:\n"
    "                           each clip, rest, the poses of the tears, range of motion, random "
    "poses;\n"
    "                           of all rigged files and 200 random rigs, three seeds, four tears\n"
    "  refit_groups             number of these groups\n"
    "  refit_groups_lost        those with a gain below 1\n"
    "  refit_rigs               number of these rigs\n"
    "  refit_vs_today_time      time of a fit within bounds over groups of poses / that over the\n"
    "                           same poses as one group, without bounds; median of models\n";

int run(bool wants_summary, const char* json, const char* picture) {
  std::vector<WeightsModel> models = make_weights_models();
  std::vector<ModelFigures> figures;
  std::vector<WeightProblem> problems;
  for (WeightsModel& model : models) {
    figures.push_back(measure_model(model));
    const auto& of_model = figures.back().solvers.problems;
    problems.insert(problems.end(), of_model.begin(), of_model.end());
  }
  const RigFigures rigs = measure_rigs(models);
  if (wants_summary)
    print_weights_summary(summarise(figures, rigs), stdout);
  else
    print_weights_tables(figures, rigs, measure_lip_quality(), run_other_solvers(problems));
  if (json != nullptr && !write_weights_json(figures, rigs, json)) {
    std::fprintf(stderr, "%s cannot be written\n", json);
    return 1;
  }
  if (picture != nullptr && !write_weights_picture(figures, picture)) {
    std::fprintf(stderr, "%s cannot be written\n", picture);
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  bool wants_summary = false;
  const char *json = nullptr, *picture = nullptr;
  for (int i = 1; i < argc; ++i) {
    const bool has_next = i + 1 < argc;
    if (std::strcmp(argv[i], "--summary") == 0) {
      wants_summary = true;
    } else if (std::strcmp(argv[i], "--json") == 0 && has_next) {
      json = argv[++i];
    } else if (std::strcmp(argv[i], "--svg") == 0 && has_next) {
      picture = argv[++i];
    } else {
      const bool asked = std::strcmp(argv[i], "--help") == 0;
      std::fputs(sunder::bench::kHelp, asked ? stdout : stderr);
      return asked ? 0 : 2;
    }
  }
  return sunder::bench::run(wants_summary, json, picture);
}
