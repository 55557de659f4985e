// Weights of torn points: what they cost, and how far the points then stand from the surface that
// was torn.

#include <cstdio>
#include <cstring>

#include "bench/weights_output.h"
#include "bench/weights_picture.h"
#include "tear/surface/mesh_vertices.h"

namespace sunder::bench {
namespace {

constexpr const char* kHelp =
    "bench_weights [--summary] [--json FILE] [--svg FILE]\n"
    "\n"
    "Tears a procedural rig and six models of ../shared/models five times each, in bent poses, and "
    "weighs the points by every "
    "policy with\n"
    "at most 4, 8 and all influences. Errors are of all points of a model, over the poses that "
    "refits are fitted over and over "
    "others,\n"
    "held out: of the model's clips (8 samples each), and of a range of motion. 'pop' is the "
    "largest one in the pose of the tear; "
    "of\n"
    "pose_exact without points whose bones turn too far apart for it, which 'fell back'.\n"
    "\n"
    "Times are of functions of `weights`, over all points of a model, the least of many runs, "
    "where corners, matrices and moments "
    "are\n"
    "there. barycentric: mean_influences() and prune_influences(); the others that and "
    "AnimationPoint, pose_exact also\n"
    "solve_bind_position(), refit PointRefit::fit() over the poses of clips, or of the range of "
    "motion where there are none.\n"
    "\n"
    "Prints tables. --summary prints one JSON object instead. Parts are of the diagonal at rest; K "
    "= 4.\n"
    "  exact_max_rel            largest error of exact points of SkinnedMesh, in float, over all "
    "poses\n"
    "  pose_exact_pop_rel       largest pop of pose_exact\n"
    "  refit_gain_clips_median  RMS error of barycentric weights by that of the refit, in clip "
    "poses held out; median of models,\n"
    "                           without those where one bone moves all points: nothing to gain\n"
    "  refit_gain_rom_median    the same over the range of motion\n"
    "  refit_gain_min           least of both, of all models\n"
    "  refit_vs_exhaustive      RMS error of the refit, in the poses of the fit, by that of a "
    "search over all choices of bones; 60 "
    "points a\n"
    "                           model that at most 8 bones move; largest of models and both sets "
    "of poses\n"
    "  refit_us                 PointRefit::fit() alone, weights alone, 16 poses, microseconds a "
    "point\n"
    "  barycentric_us           mean_influences() and prune_influences(), likewise\n";

int run(bool wants_summary, const char* json, const char* picture) {
  std::vector<WeightsModel> models = make_weights_models();
  std::vector<ModelFigures> figures;
  std::vector<WeightProblem> problems;
  for (WeightsModel& model : models) {
    figures.push_back(measure_model(model));
    const auto& of_model = figures.back().solvers.problems;
    problems.insert(problems.end(), of_model.begin(), of_model.end());
  }
  if (wants_summary)
    print_weights_summary(summarise(figures), stdout);
  else
    print_weights_tables(figures, run_other_solvers(problems));
  if (json != nullptr && !write_weights_json(figures, json)) {
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
