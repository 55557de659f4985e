#include <string>

#include "pipeline/validation/internal/option_ranges.h"
#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {
namespace {

/// Where matches are sought and which are accepted.
void add_match_rules(CLI::App& verb, TransferOptions& options) {
  takes(verb.add_option("--distance", options.distance,
                        "Largest distance of a match, share of the target's diagonal"),
        validation::kDistance, Quantity::share)
      ->capture_default_str();
  takes(verb.add_option_function<double>(
            "--angle", [&options](double degrees) { options.angle = degrees / 57.295779513082323; },
            "Largest angle between the normals of a match, degrees"),
        validation::kAngleDegrees, Quantity::angle)
      ->default_str("30");
  verb.add_flag("--flip-normals", options.flip_normals,
                "Normals that point the opposite way agree too");
  verb.add_flag("--isolate-parts", options.isolate_parts,
                "Match each connected part to one part of the source");
  verb.add_flag("--keep-sides-apart", options.keep_sides_apart,
                "Bones named left only for vertices on the left, and likewise on the right");
}

/// Whose weights are replaced, and by what.
void add_weight_rules(CLI::App& verb, TransferRequest& request) {
  TransferOptions& options = request.options;
  verb.add_option_function<std::string>(
          "--method",
          [&options](const std::string& name) {
            options.method =
                name == "closest" ? TransferMethod::closest_point : TransferMethod::inpainting;
          },
          "closest: interpolate at the closest place; inpainting: fill in where none is accepted")
      ->check(CLI::IsMember({"closest", "inpainting"}))
      ->default_str("inpainting");
  takes(verb.add_option("--smoothness", options.smoothness,
                        "Weight of the bi-Laplacian where weights are filled in, squared "
                        "diagonals"),
        validation::kSmoothness)
      ->capture_default_str();
  takes_count(
      verb.add_option("--smoothing", options.smoothing_sweeps, "Sweeps of smoothing after that"), 0,
      1'000'000)
      ->capture_default_str();
  takes_count(verb.add_option("--influences", options.maximum_influences,
                              "Largest number of influences per vertex; 0: all"),
              0, kMostInfluences)
      ->capture_default_str();
  verb.add_option("--bone-names", request.bone_names,
                  "JSON file of bones whose names differ: {\"of the target\": \"of the source\"}")
      ->type_name("FILE");
  verb.add_option("--bones", options.bones, "Only these bones of the source, separated by commas")
      ->type_name("NAMES")
      ->delimiter(',')
      ->allow_extra_args(false);
  takes(verb.add_option("--mix", options.mix,
                        "Share of the new weights; the rest are the target's own"),
        validation::kMix, Quantity::share)
      ->capture_default_str();
  verb.add_option("--vertices", request.vertices,
                  "JSON file of the vertices that change: {\"mesh\": [0, 1, 2]}")
      ->type_name("FILE");
  verb.add_option("--lock", request.lock,
                  "Attribute of the target; vertices with 0.5 or more keep their weights")
      ->type_name("NAME");
}

}  // namespace

CLI::App* add_transfer(CLI::App& app, TransferRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "transfer", "Give a model the skin of another one that stands in the same place");
  verb->add_option("SOURCE", request.source, "The model with the skin")
      ->type_name("FILE")
      ->required();
  verb->add_option("TARGET", request.target, "The model that gets it")
      ->type_name("FILE")
      ->required();
  const CLI::Option* const output =
      verb->add_option("-o,--output", request.output,
                       "The target with its new weights: GLB, or USD if it ends in .usda or .usdz")
          ->type_name("FILE");
  verb->add_flag("--clips", request.copies_clips,
                 "Write the source's clips too, for bones that rest alike in both");
  verb->add_flag("--dry-run", request.options.dry_run, "Only match; write no model");
  add_match_rules(*verb, request.options);
  add_weight_rules(*verb, request);
  add_weights_as(*verb, request.save);
  add_maximum_error(*verb, request.maximum_error);
  verb->add_option("--report", request.report, "File for a JSON report")->type_name("FILE");
  verb->callback([&request, verb, output] {
    if (request.options.dry_run && request.maximum_error)
      throw CLI::ValidationError("--max-error", "needs a model to write: not with --dry-run");
    if (request.options.dry_run == (output->count() > 0))
      throw CLI::ValidationError("--output", "is needed without --dry-run, and only then");
    check_output_format(*verb, request.output);
  });
  add_model_reading(*verb, request.reading);
  add_budget(*verb, request.budget);
  verb->footer(
      "Exit code 1 with warnings, 2 if nothing matched; then nothing is written.\n\n"
      "Example: sunder transfer body.glb jacket.glb -o skinned.glb --influences 4");
  return verb;
}

}  // namespace sunder::tools
