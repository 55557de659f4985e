#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#if SUNDER_COUPLED_REFIT
#include <sunder/coupled_refit/use.h>
#endif

#include "tools/length.h"
#include "tools/verbs.h"
#include "tools/weight_report.h"
#include "tools/written_influences.h"

namespace sunder::tools {
namespace {

constexpr const char* kExitCodes =
    "`sunder VERB --help` describes one verb; docs/command.md has all details.\n\n"
    "Exit codes:\n"
    "  0  done\n"
    "  1  done, with findings\n"
    "  2  the command line or the operations are invalid\n"
    "  3  a file cannot be read or written\n"
    "  4  a limit was exceeded: size, memory, time\n"
    "  5  internal error; please report it\n"
    "Data goes to stdout, messages go to stderr.";

/// @param name  a result of weight_format_name().
WeightFormat weight_format(const std::string& name) {
  for (const WeightFormat format : {WeightFormat::unorm16, WeightFormat::unorm8})
    if (name == weight_format_name(format)) return format;
  return WeightFormat::float32;
}

/// @param name  a result of weight_policy_name().
WeightPolicy weight_policy(const std::string& name) {
  for (const WeightPolicy policy :
       {WeightPolicy::pose_exact, WeightPolicy::refit, WeightPolicy::exact})
    if (name == weight_policy_name(policy)) return policy;
  return WeightPolicy::barycentric;
}

/// `--max-error` and its limits, which exclude that the caller chooses influences and format.
void add_maximum_error(CLI::App& verb, std::optional<MaximumError>& wanted) {
  CLI::Option* const length =
      verb.add_option_function<std::string>(
              "--max-error",
              [&wanted](const std::string& text) { wanted = MaximumError{*parse_length(text)}; },
              "Write as few influences and bits as keep every vertex within this distance of the "
              "unpruned skin in every pose: 0.1mm, 1cm, or metres")
          ->check(CLI::Validator(
              [](const std::string& text) {
                return parse_length(text)
                           ? std::string()
                           : "'" + text + "' is no length; expected 0.1mm, 1cm, 20um or metres";
              },
              "LENGTH"));
  for (const char* const other : {"--influences", "--weights-as"})
    length->excludes(verb.get_option(other));
  verb.add_option_function<std::string>(
          "--limits",
          [&wanted](const std::string& limits) {
            if (wanted) wanted->limits = limits;  // else refused: needs --max-error
          },
          "Joint limits for --max-error: none, clips or a JSON file")
      ->needs(length)
      ->default_str("none");
}

struct Requests {
  InfoRequest info;
  TearRequest tear;
  DemoRequest demo;
  TransferRequest transfer;
  ValidateRequest validate;
};

CLI::App* add_info(CLI::App& app, InfoRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "info", "Describe a model: meshes, bones, clips, topology, and faults that loading repaired");
  verb->add_option("MODEL", request.model,
                   "Model file: glTF, GLB, FBX, COLLADA, X, B3D, OBJ, PLY, OFF ...")
      ->required();
  verb->add_flag("--json", request.as_json, "Print one JSON object instead of text");
  verb->footer(
      "Exit code 1 if loading repaired or dropped something.\n\nExample: sunder info fox.glb");
  return verb;
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
  verb->add_option_function<std::string>(
          "--weights-as",
          [&request](const std::string& name) { request.save.weights = weight_format(name); },
          "Number format of the written weights; u16 and u8 are normalised integers that sum to "
          "exactly one")
      ->check(CLI::IsMember({"float", "u16", "u8"}))
      ->default_str("float");
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

CLI::App* add_demo(CLI::App& app, DemoRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "demo", "Tear a model in the middle of its animation and draw pictures of it");
  verb->add_option("MODEL", request.model,
                   "Model file, as for `sunder info`; default: a cactus that is generated by code");
  verb->add_option("-o,--output", request.folder,
                   "Folder for the pictures, the torn model, the operation log and the report")
      ->capture_default_str();
  verb->footer(
      "The pictures need f3d and Xvfb. Without these everything else is still written, and the "
      "exit code is 1.\n\n"
      "Example: sunder demo fox.glb -o fox_demo");
  return verb;
}

/// Where matches are sought and which are accepted.
void add_match_rules(CLI::App& verb, TransferOptions& options) {
  verb.add_option("--distance", options.distance,
                  "Largest distance of a match, share of the target's diagonal")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb.add_option_function<double>(
          "--angle", [&options](double degrees) { options.angle = degrees / 57.295779513082323; },
          "Largest angle between the normals of a match, degrees")
      ->check(CLI::Range(0.0, 180.0))
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
  verb.add_option("--smoothness", options.smoothness,
                  "Weight of the bi-Laplacian where weights are filled in, squared diagonals")
      ->capture_default_str();
  verb.add_option("--smoothing", options.smoothing_sweeps, "Sweeps of smoothing after that")
      ->capture_default_str();
  verb.add_option("--influences", options.maximum_influences,
                  "Largest number of influences per vertex; 0: all")
      ->capture_default_str();
  verb.add_option("--bone-names", request.bone_names,
                  "JSON file of bones whose names differ: {\"of the target\": \"of the source\"}");
  verb.add_option("--bones", options.bones, "Only these bones of the source, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--mix", options.mix, "Share of the new weights; the rest are the target's own")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_option("--vertices", request.vertices,
                  "JSON file of the vertices that change: {\"mesh\": [0, 1, 2]}");
  verb.add_option("--lock", request.lock,
                  "Attribute of the target; vertices with 0.5 or more keep their weights");
}

CLI::App* add_transfer(CLI::App& app, TransferRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "transfer", "Give a model the skin of another one that stands in the same place");
  verb->add_option("SOURCE", request.source, "The model with the skin")->required();
  verb->add_option("TARGET", request.target, "The model that gets it")->required();
  const CLI::Option* const output =
      verb->add_option("-o,--output", request.output, "The target with its new weights, GLB");
  verb->add_flag("--dry-run", request.options.dry_run, "Only match; write no model");
  add_match_rules(*verb, request.options);
  add_weight_rules(*verb, request);
  verb->add_option_function<std::string>(
          "--weights-as",
          [&request](const std::string& name) { request.save.weights = weight_format(name); },
          "Format of the weights; u16 and u8 are integers that sum to exactly one")
      ->check(CLI::IsMember({"float", "u16", "u8"}))
      ->default_str("float");
  add_maximum_error(*verb, request.maximum_error);
  verb->add_option("--report", request.report, "File for a JSON report");
  verb->callback([&request, output] {
    if (request.options.dry_run && request.maximum_error)
      throw CLI::ValidationError("--max-error", "needs a model to write: not with --dry-run");
    if (request.options.dry_run == (output->count() > 0))
      throw CLI::ValidationError("--output", "is needed without --dry-run, and only then");
  });
  verb->footer(
      "Exit code 1 with warnings, 2 if nothing matched; then nothing is written.\n\n"
      "Example: sunder transfer body.glb jacket.glb -o skinned.glb --influences 4");
  return verb;
}

CLI::App* add_validate(CLI::App& app, ValidateRequest& request) {
  CLI::App* const verb =
      app.add_subcommand("validate", "Compare how the skins of a source and a target deform");
  CLI::Option* const source = verb->add_option("SOURCE", request.source, "The model as it was");
  CLI::Option* const target =
      verb->add_option("TARGET", request.target, "The model that a tool made of it");
  source->needs(target);
  verb->add_option("--ops", request.operations, "The operation log that made the target");
  verb->add_option("--bone-names", request.bone_names,
                   "JSON file of bones whose names differ: {\"of the target\": \"of the source\"}");
  verb->add_option("--profile", request.profile, "Simulate the limits of a platform")
      ->check(CLI::IsMember({"unity4", "unreal8", "gltf4", "gltf8", "webxr"}));
  verb->add_option("--limits", request.limits,
                   "Limits of joints for the certificate: none, clips or a JSON file")
      ->capture_default_str();
  verb->add_option("--fail-on", request.fail_on, "Least severity for exit code 1")
      ->check(CLI::IsMember({"error", "warning", "note"}))
      ->capture_default_str();
  verb->add_option("--report", request.report, "File for the JSON report");
  verb->add_option("--html", request.html, "File for a page with both models, which opens offline");
  CLI::Option* const manifest =
      verb->add_option("--manifest", request.manifest, "Many pairs, JSON; see docs/validation.md");
  verb->add_option("--jobs", request.jobs, "Pairs of a manifest at a time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  verb->add_flag("--json-lines", request.as_json_lines,
                 "Print progress and results as one JSON object per line");
  manifest->excludes(source)->excludes(target);
  verb->callback([source, target, manifest] {
    if (!*manifest && (!*source || !*target))
      throw CLI::RequiredError("SOURCE and TARGET, or --manifest");
  });
  verb->footer(
      "Exit code 1 if there is a finding at or above --fail-on.\n\n"
      "Example: sunder validate fox.glb torn.glb --ops ops.json --limits clips");
  return verb;
}

int run(int argc, char** argv) {
#if SUNDER_COUPLED_REFIT
  use_coupled_refit();
#endif
  Requests requests;
  CLI::App app("Tears rigged, animated models.", "sunder");
  app.set_version_flag("--version", "sunder " SUNDER_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  const CLI::App* const info = add_info(app, requests.info);
  const CLI::App* const tear = add_tear(app, requests.tear);
  const CLI::App* const transfer = add_transfer(app, requests.transfer);
  const CLI::App* const validate = add_validate(app, requests.validate);
  add_demo(app, requests.demo);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? static_cast<int>(ExitCode::ok)
                                : static_cast<int>(ExitCode::usage);
  }
  if (info->parsed()) return static_cast<int>(run_info(requests.info));
  if (tear->parsed()) return static_cast<int>(run_tear(requests.tear));
  if (transfer->parsed()) return static_cast<int>(run_transfer(requests.transfer));
  if (validate->parsed()) return static_cast<int>(run_validate(requests.validate));
  return static_cast<int>(run_demo(requests.demo));
}

}  // namespace
}  // namespace sunder::tools

int main(int argc, char** argv) {
  using sunder::tools::ExitCode;
  try {
    return sunder::tools::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("sunder: out of memory\n", stderr);
    return static_cast<int>(ExitCode::limit_exceeded);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sunder: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::internal_error);
  }
}
