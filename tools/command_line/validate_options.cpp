#include "pipeline/validation/internal/option_ranges.h"
#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {

CLI::App* add_validate(CLI::App& app, ValidateRequest& request) {
  CLI::App* const verb =
      app.add_subcommand("validate", "Compare how the skins of a source and a target deform");
  CLI::Option* const source =
      verb->add_option("SOURCE", request.source, "The model as it was")->type_name("FILE");
  CLI::Option* const target =
      verb->add_option("TARGET", request.target, "The model that a tool made of it")
          ->type_name("FILE");
  source->needs(target);
  verb->add_option("--ops", request.operations, "The operation log that made the target")
      ->type_name("FILE");
  verb->add_option("--bone-names", request.bone_names,
                   "JSON file of bones whose names differ: {\"of the target\": \"of the source\"}")
      ->type_name("FILE");
  verb->add_option("--profile", request.profile, "Simulate the limits of a platform")
      ->check(CLI::IsMember({"unity4", "unreal8", "gltf4", "gltf8", "webxr"}));
  verb->add_option("--limits", request.limits,
                   "Limits of joints for the certificate: none, clips, or a JSON or URDF file")
      ->type_name("none|clips|FILE")
      ->capture_default_str();
  verb->add_option("--fail-on", request.fail_on, "Least severity for exit code 1")
      ->check(CLI::IsMember({"error", "warning", "note"}))
      ->capture_default_str();
  takes(verb->add_option("--error-deviation", request.error_deviation,
                         "Share of the source's diagonal from which a deviation is an error"),
        validation::kErrorDeviation, Quantity::share)
      ->type_name("SHARE")
      ->capture_default_str();
  verb->add_option("--report", request.report, "File for the JSON report")->type_name("FILE");
  verb->add_option("--html", request.html, "File for a page with both models, which opens offline")
      ->type_name("FILE");
  CLI::Option* const manifest =
      verb->add_option("--manifest", request.manifest,
                       "Many pairs, JSON; it names the files that are read and written, anywhere")
          ->type_name("FILE");
  takes_count(verb->add_option("--jobs", request.jobs, "Pairs of a manifest at a time"), 1, 256)
      ->capture_default_str();
  verb->add_flag("--json-lines", request.as_json_lines,
                 "Print progress and results as one JSON object per line");
  manifest->excludes(source)->excludes(target);
  verb->callback([source, target, manifest] {
    if (!*manifest && (!*source || !*target))
      throw CLI::RequiredError("SOURCE and TARGET, or --manifest");
  });
  add_model_reading(*verb, request.reading);
  add_budget_of_operations(*verb, request.budget);
  verb->footer(
      "Exit code 1 if there is a finding at or above --fail-on.\n\n"
      "Example: sunder validate fox.glb torn.glb --ops ops.json --limits clips");
  return verb;
}

}  // namespace sunder::tools
