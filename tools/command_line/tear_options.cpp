#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/operation/internal/field_ranges.h"
#include "core/operation/internal/names.h"
#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"
#include "tools/model/model_output.h"
#include "tools/model/name_at.h"
#include "tools/model/quantity.h"
#include "tools/written_weights/written_influences.h"

namespace sunder::tools {
namespace {

/// @param name  one of kNames<WeightPolicy>.
WeightPolicy weight_policy(const std::string& name) {
  const auto& names = kNames<WeightPolicy>;
  return static_cast<WeightPolicy>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// How new vertices are skinned.
void add_weight_policy(CLI::App& verb, TearRequest& request) {
  verb.add_option_function<std::string>(
          "--weights",
          [&request](const std::string& name) { request.weights = weight_policy(name); },
          "How new vertices are skinned if their operation has no 'weights'; see docs/weights.md. "
          "--influences applies to them too")
      ->check(CLI::IsMember(
          std::vector<std::string>(kNames<WeightPolicy>.begin(), kNames<WeightPolicy>.end())))
      ->default_str(kNames<WeightPolicy>.front());
  verb.add_option_function<std::string>(
          "--refit-over",
          [&request](const std::string& text) {
            const auto options = parse_refit_over(text);
            if (!options)
              throw CLI::ValidationError("--refit-over", std::string(options.error().text()));
            request.refit_over = *options;
          },
          "Poses to fit over, with --weights refit: clips, clips:NAME=FACTOR, range_of_motion, "
          "separated by commas")
      ->type_name("POSES")
      ->default_str("clips,range_of_motion, or what the model has");
  takes(verb.add_option("--refit-bound", request.refit_bound,
                        "Largest growth of the certified worst deviation by a refit; 0: any"),
        {.field = "the value", .least = 0, .most = field::kBound.most})
      ->type_name("FACTOR")
      ->capture_default_str();
}

/// @throws CLI::ValidationError
void check_weight_policy(const CLI::App& verb, const TearRequest& request) {
  const bool has_bound = verb.count("--refit-bound") > 0;
  if (request.weights != WeightPolicy::refit && (request.refit_over || has_bound))
    throw CLI::ValidationError(request.refit_over ? "--refit-over" : "--refit-bound",
                               "needs --weights refit");
  if (request.refit_bound != 0) check_value("--refit-bound", field::kBound, request.refit_bound);
}

/// Options that say what is reported, and where.
void add_report_options(CLI::App& verb, TearRequest& request) {
  CLI::Option* const report =
      verb.add_option("--report", request.report,
                      "File for the JSON report; -: stdout. Without it, a summary goes to stdout")
          ->type_name("FILE");
  verb.add_flag("--weight-errors", request.weight_errors,
                "Measure for the report how far new points are from the untorn surface, on a "
                "sample of points and poses")
      ->needs(report);
  verb.add_flag("--count-topology", request.count_topology,
                "Count for the report the components and boundary loops before and after each "
                "operation")
      ->needs(report);
  CLI::Option* const quiet = verb.add_flag_callback(
      "-q,--quiet", [&request] { request.verbosity = Verbosity::quiet; },
      "Print errors and misses only: no other operations, warnings and summary");
  verb.add_flag_callback(
          "-v,--verbose", [&request] { request.verbosity = Verbosity::verbose; },
          "Print details of operations, and durations")
      ->excludes(quiet);
}

/// Options that name further outputs.
void add_further_files(CLI::App& verb, TearRequest& request) {
  CLI::Option* const pieces =
      verb.add_option(
              "--pieces", request.pieces,
              "Write each detached piece too, as the model: to PREFIX1.glb, PREFIX2.glb ...")
          ->type_name("PREFIX");
  verb.add_flag("--animated-pieces", request.pieces_are_animated,
                "Pieces keep their bones and clips; otherwise each is one rigid body, as it stood")
      ->needs(pieces);
  verb.add_option(
          "--save-log", request.log,
          "File for the operation log of what was applied and not undone, with all bone matrices")
      ->type_name("FILE");
}

void add_wound_mask(CLI::App& verb, TearRequest& request) {
  constexpr NumberRange kReach = {.field = "the value", .least = 1e-6, .most = 1e6, .unit = " m"};
  constexpr unsigned kMostTexels = 16'384;
  CLI::Option* const file =
      verb.add_option("--wound-mask", request.wound_mask,
                      "File for a texture (PNG) of the wounds, in the model's own texture "
                      "coordinates: red near lips, green where skin was removed")
          ->type_name("FILE");
  takes_count(
      verb.add_option("--wound-mask-size", request.wound_mask_size, "Texels a side of the texture")
          ->type_name("TEXELS")
          ->capture_default_str(),
      1, kMostTexels)
      ->needs(file);
  takes(verb.add_option("--wound-mask-reach", request.wound_mask_reach,
                        "Distance from a lip, along the skin, at which red ends")
            ->type_name("METRES")
            ->capture_default_str(),
        kReach, Quantity::length)
      ->needs(file);
  verb.add_option_function<std::vector<std::string>>(
          "--wound-mask-channels",
          [&request](const std::vector<std::string>& names) {
            for (std::size_t i = 0; i < kMaskChannels.size(); ++i)
              if (std::ranges::find(names, kMaskChannels[i]) != names.end())
                request.wound_mask_channels.push_back(static_cast<MaskChannel>(i));
          },
          "Textures in grey beside it, one each of age, depth, stretch and blood")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(kMaskChannels.begin(), kMaskChannels.end())))
      ->type_name("CHANNELS")
      ->needs(file);
}

/// @param name  a result of influences_name().
std::uint32_t maximum_influences(const std::string& name) {
  for (const std::uint32_t maximum : {4u, 8u, kAllInfluences})
    if (name == influences_name(maximum)) return maximum;
  return 0;
}

void add_influences(CLI::App& verb, TearRequest& request) {
  verb.add_option_function<std::string>(
          "--influences",
          [&request](const std::string& name) {
            request.save.maximum_influences = maximum_influences(name);
          },
          "Influences written per vertex: source (no more than there, at least 4), the 4 or 8 "
          "largest, renormalised, or all")
      ->check(CLI::IsMember({"source", "4", "8", "all"}))
      ->default_str("source");
}

/// Reads "Walk@0.5" and "Walk@0.5..1.2".
std::optional<TearRequest::OpenSpan> open_span_in(const std::string& text) {
  const NameAt parts = split_name_at(text);
  if (parts.name.empty() || !parts.at) return std::nullopt;
  const std::string& clip = parts.name;
  const std::string& times = *parts.at;
  const std::size_t dots = times.find("..");
  const auto begin = quantity_in(times.substr(0, dots), Quantity::time);
  if (!begin || !(*begin >= 0)) return std::nullopt;
  if (dots == std::string::npos) return TearRequest::OpenSpan{clip, *begin, {}};
  const auto end = quantity_in(times.substr(dots + 2), Quantity::time);
  if (!end || !(*end > *begin)) return std::nullopt;
  return TearRequest::OpenSpan{clip, *begin, *end};
}

void add_open_span(CLI::App& verb, CLI::Option* open, TearRequest& request) {
  verb.add_option_function<std::string>(
          "--open-span",
          [&request](const std::string& text) {
            request.open_span = open_span_in(text);
            if (!request.open_span)
              throw CLI::ValidationError(
                  "--open-span", "'" + text +
                                     "': expected CLIP@START or CLIP@START..END, seconds, 0 or "
                                     "more and ascending");
          },
          "When lips open in a clip, whatever the pose of the tear: from a moment on, or evenly "
          "over a span")
      ->type_name("CLIP@START[..END]")
      ->needs(open);
}

void add_tissue_fields(CLI::App& verb, TearRequest& request) {
  verb.add_option_function<std::vector<std::string>>(
          "--tissue-field",
          [&request](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const Result<TissueField> field = parse_tissue_field(text);
              std::string fault(field.error().text());
              if (field && std::ranges::find(request.tissue_fields, field->factor,
                                             &TissueField::factor) != request.tissue_fields.end())
                fault = "a second field of " + field->factor;
              if (!fault.empty()) throw CLI::ValidationError("--tissue-field " + text, fault);
              request.tissue_fields.push_back(*field);
            }
          },
          "How the tissue of --open and --picture varies: stiffness, tension or thickness by a "
          "factor that is bone:NAME, color:COLOR_0, attribute:_NAME or texture:FILE.png; at_zero "
          "and at_one: the factors at 0 and 1. Once per factor")
      ->allow_extra_args(false)
      ->type_name("FACTOR=SOURCE[,at_zero=F][,at_one=F]");
}

/// A flag that may have a value after "=", so that it takes no other argument for it.
void add_open(CLI::App& verb, TearRequest& request) {
  const auto form = std::make_shared<std::string>();
  CLI::Option* const flag =
      verb.add_flag("--open{morph}", *form,
                    "Write lips that gape, as a morph target and an animation of its weight from "
                    "the moment of the tear; --open=baked: in the positions themselves");
  flag->check([form](const std::string& value) {
    const bool is_known = value == "morph" || value == "baked" || value == "true";
    return is_known ? std::string() : "expected --open, --open=morph or --open=baked";
  });
  add_open_span(verb, flag, request);
  add_tissue_fields(verb, request);
  verb.add_option_function<std::string>(
          "--flesh",
          [&request](const std::string& text) {
            const Result<FleshOption> flesh = parse_flesh(text);
            if (!flesh) throw CLI::ValidationError("--flesh", std::string(flesh.error().text()));
            request.flesh = *flesh;
          },
          "What caps, walls and the ground between gaping lips are made of: a colour (#8a2b22), "
          "roughness=SHARE and name=TEXT, separated by commas; source: the material of the surface "
          "beside; none: as that, and no ground between lips")
      ->type_name("FLESH")
      ->default_str("red flesh; the material of the surface beside on cloth, metal and things");
  verb.parse_complete_callback([&verb, form, &request] {
    if (verb.count("--open") > 0)
      request.open = *form == "baked" ? OpenLips::baked : OpenLips::morph;
    if (request.open_span && request.open == OpenLips::baked)
      throw CLI::ValidationError("--open-span", "needs --open or --open=morph");
    if (!request.tissue_fields.empty() && request.open == OpenLips::no && !request.picture)
      throw CLI::ValidationError("--tissue-field", "needs --open or --picture");
  });
}

/// As add_open(): its value is after "=".
void add_blood(CLI::App& verb, TearRequest& request) {
  constexpr NumberRange kReach = {.field = "the value", .least = 1e-6, .most = 1e6, .unit = " m"};
  const auto unused = std::make_shared<std::string>();
  verb.add_flag("--blood{size}", *unused,
                "Write blood around wounds into the textures; --blood=0.02: up to 2 cm from lips")
      ->each([unused, &request, kReach](const std::string& text) {
        request.blood = 0.0;
        if (text == "size" || text == "true") return;
        const std::optional<double> value = quantity_in(text, Quantity::length);
        if (!value)
          throw CLI::ValidationError("--blood", "'" + text + "' is no number; expected one " +
                                                    kReach.text() + units_of(Quantity::length));
        check_value("--blood", kReach, *value);
        request.blood = *value;
      });
}

/// @throws CLI::ValidationError
void check_output(CLI::App& verb, const TearRequest& request) {
  check_output_format(verb, *request.output);
  if (request.blood && is_usd(*request.output))
    throw CLI::ValidationError("--blood", "needs a GLB as --output");
}

}  // namespace

CLI::App* add_tear(CLI::App& app, TearRequest& request) {
  const auto robot = std::make_shared<RobotTearRequest>();  // lives as long as the options
  CLI::App* const verb = app.add_subcommand(
      "tear", "Apply a list of tears, cuts and bores to a model and save it as GLB or USD");
  verb->add_option("MODEL", request.model, "Model file, as for `sunder info`")
      ->type_name("FILE")
      ->required();
  verb->add_option(
          "--ops", request.operations,
          "Operation log, JSON: the tears, cuts and bores to apply; see docs/operation_log.md")
      ->type_name("FILE");
  add_aimed_operations(*verb);
  add_robot(*verb, *robot,
            "Robot, URDF, whose blade tears the model after --ops and the options above; see "
            "docs/robot_tears.md");
  verb->add_option("-o,--output", request.output,
                   "File for the torn model: GLB, or USD if it ends in .usda or .usdz")
      ->type_name("FILE");
  add_influences(*verb, request);
  add_weights_as(*verb, request.save);
  add_weight_policy(*verb, request);
  add_maximum_error(*verb, request.maximum_error, &request.robot_limits);
  add_report_options(*verb, request);
  add_open(*verb, request);
  add_blood(*verb, request);
  verb->add_option("--picture", request.picture,
                   "File for a picture (PNG) of the torn model, with lips and pieces pulled apart")
      ->type_name("FILE");
  add_wound_mask(*verb, request);
  add_further_files(*verb, request);
  verb->add_flag("--keep-going", request.keep_going,
                 "Report operations that cannot be applied, leave them out and go on");
  verb->add_flag("--dry-run", request.dry_run,
                 "Apply and describe the operations, but write no files");
  verb->add_flag("--no-origins", request.without_origins,
                 "Writes no record of where new vertices come from");
  verb->add_flag("--force", request.force, "Outputs may overwrite the model or the log");
  verb->callback([&request, verb, robot] {
    check_weight_policy(*verb, request);
    read_aimed_operations(*verb, request);
    if (verb->count("--pose") > 0) robot->pose = verb->get_option("--pose")->results().back();
    if (has_robot(*verb, *robot, true)) request.robot = *robot;
    if (request.operations.empty() && request.aimed.empty() && !request.robot)
      throw CLI::RequiredError("--ops (or --slash, --sever, --puncture, --robot)");
    if (!request.dry_run && !request.output) throw CLI::RequiredError("--output (or --dry-run)");
    if (request.output) check_output(*verb, request);
  });
  add_model_reading(*verb, request.reading);
  add_budget_of_operations(*verb, request.budget);
  verb->footer(
      "If an operation fails, nothing is written. Exit code 1 if an operation met no surface or "
      "could not tear some places (see the report), or if the picture could not be drawn.\n\n"
      "Examples:\n"
      "  sunder tear fox.glb --ops ops.json -o torn.glb --influences 4\n"
      "  sunder tear fox.glb --slash b_Neck_04@0.5,length=0.8w,turn=30 --sever b_Tail02_013 "
      "--pose Walk@0.5 -o torn.glb\n"
      "  sunder tear fox.glb --robot arm.urdf --trajectory arm.csv --blade tool -o torn.glb");
  return verb;
}

}  // namespace sunder::tools
