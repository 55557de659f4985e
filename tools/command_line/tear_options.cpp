#include <string>

#include "tools/command_line/options.h"

namespace sunder::tools {
namespace {

/// @param name  a result of weight_policy_name().
WeightPolicy weight_policy(const std::string& name) {
  for (const WeightPolicy policy :
       {WeightPolicy::pose_exact, WeightPolicy::refit, WeightPolicy::exact})
    if (name == weight_policy_name(policy)) return policy;
  return WeightPolicy::barycentric;
}

/// How new vertices are skinned.
void add_weight_policy(CLI::App& verb, TearRequest& request) {
  verb.add_option_function<std::string>(
          "--weights",
          [&request](const std::string& name) { request.weights = weight_policy(name); },
          "How new vertices are skinned if their operation has no 'weights'; see docs/weights.md. "
          "--influences applies to them too")
      ->check(CLI::IsMember({"barycentric", "pose_exact", "refit", "exact"}))
      ->default_str("barycentric");
  verb.add_option_function<std::string>(
          "--refit-over",
          [&request](const std::string& text) {
            const auto options = parse_refit_over(text);
            if (!options)
              throw CLI::ValidationError("--refit-over", std::string(options.error().text()));
            request.refit_over = *options;
          },
          "Poses to fit over, with --weights refit: clips, clips:NAME=FACTOR, range_of_motion, "
          "separated by commas; default: clips,range_of_motion, or what the model has")
      ->type_name("POSES");
  const CLI::Option* const bound =
      verb.add_option("--refit-bound", request.refit_bound,
                      "Largest growth of the certified worst deviation by a refit; 0: any")
          ->check(CLI::Range(0.0, 1e9))
          ->capture_default_str();
  verb.callback([&request, bound] {
    if (request.weights != WeightPolicy::refit && (request.refit_over || *bound))
      throw CLI::ValidationError(request.refit_over ? "--refit-over" : "--refit-bound",
                                 "needs --weights refit");
    if (request.refit_bound > 0 && request.refit_bound < 1)
      throw CLI::ValidationError("--refit-bound", "expected a factor of at least 1, or 0");
  });
}

}  // namespace

CLI::App* add_tear(CLI::App& app, TearRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "tear", "Apply a list of tears, cuts and bores to a model and save it as GLB");
  verb->add_option("MODEL", request.model, "Model file, as for `sunder info`")->required();
  verb->add_option(
          "--ops", request.operations,
          "Operation log, JSON: the tears, cuts and bores to apply; see docs/operation_log.md")
      ->required();
  verb->add_option("-o,--output", request.output, "File for the torn model, GLB")->required();
  verb->add_option("--influences", request.save.maximum_influences,
                   "Influences written per vertex: the 4 or 8 largest, renormalised; default: all")
      ->check(CLI::IsMember({4, 8}));
  add_weights_as(*verb, request.save);
  add_weight_policy(*verb, request);
  add_maximum_error(*verb, request.maximum_error);
  verb->add_option("--report", request.report, "File for the JSON report; default: stdout");
  verb->add_option("--picture", request.picture,
                   "File for a picture (PNG) of the torn model, with lips and pieces pulled apart; "
                   "needs f3d and Xvfb");
  verb->add_option(
      "--save-log", request.log,
      "File for the operation log of what was applied and not undone, with all bone matrices");
  verb->footer(
      "If an operation fails, nothing is written. Exit code 1 if an operation met no surface or "
      "could not tear some places (see the report), or if the picture could not be drawn.\n\n"
      "Example: sunder tear fox.glb --ops ops.json -o torn.glb --influences 4");
  return verb;
}

}  // namespace sunder::tools
