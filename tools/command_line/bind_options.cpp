#include <string>

#include "pipeline/binding/internal/option_ranges.h"
#include "tools/bind/place.h"
#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {
namespace {

/// Where the model stands when it is attached.
void add_place(CLI::App& verb, BindRequest& request) {
  verb.add_option("--pose", request.pose,
                  "Pose of the skeleton in which the model is attached: rest, bind or CLIP@TIME")
      ->type_name("POSE")
      ->capture_default_str();
  verb.add_option("--joints", request.joints,
                  "Joint values of a robot in which the model is attached: NAME=VALUE, radians or "
                  "metres, separated by commas")
      ->type_name("VALUES")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes("--pose");
  CLI::Option* const place =
      verb.add_option_function<std::string>(
              "--place",
              [&request](const std::string& text) {
                request.place = parse_place(text);
                if (!request.place)
                  throw CLI::ValidationError(
                      "--place", "'" + text + "': expected x,y,z[,roll,pitch,yaw[,scale]]");
              },
              "Place of the model in the skeleton's space: x,y,z[,roll,pitch,yaw[,scale]], metres "
              "and degrees about the fixed x, y and z axes, in this order")
          ->type_name("NUMBERS");
  verb.add_flag("--fit", request.fit,
                "Place the model such that its joints are nearest to those they are mapped to")
      ->excludes(place);
}

void add_weight_rules(CLI::App& verb, BindRequest& request) {
  CLI::Option* const map =
      verb.add_option("--map", request.map,
                      "JSON file: keep the weights, {\"bone of the model\": \"of the skeleton\"}")
          ->type_name("FILE");
  verb.add_flag("--refuse-unmapped", request.refuse_unmapped,
                "Refuse bones with weight that the map leaves out")
      ->needs(map);
  verb.add_option("--bones", request.options.bones,
                  "Only these bones of the skeleton get weight, separated by commas")
      ->type_name("NAMES")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes(map);
  takes(verb.add_option("--heat", request.options.heat,
                        "Heat of a bone; more makes narrower transitions"),
        binding::kHeat)
      ->excludes(map)
      ->capture_default_str();
  takes_count(verb.add_option("--influences", request.options.maximum_influences,
                              "Largest number of influences per vertex; 0: all"),
              0, kMostInfluences)
      ->excludes(map)
      ->capture_default_str();
}

}  // namespace

CLI::App* add_bind(CLI::App& app, BindRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "bind", "Attach a model to the skeleton of another one, by a map or by automatic weights");
  verb->add_option("MODEL", request.model, "The model whose surface is attached")
      ->type_name("FILE")
      ->required();
  verb->add_option("--skeleton", request.skeleton, "The model or robot whose skeleton moves it")
      ->type_name("FILE")
      ->required();
  verb->add_option("-o,--output", request.output,
                   "The model on that skeleton: GLB, or USD if it ends in .usda or .usdz")
      ->type_name("FILE")
      ->required();
  add_weight_rules(*verb, request);
  add_place(*verb, request);
  add_weights_as(*verb, request.save);
  verb->add_option("--report", request.report, "File for a JSON report")->type_name("FILE");
  add_model_reading(*verb, request.reading);
  add_budget(*verb, request.budget);
  verb->callback([&request, verb] { check_output_format(*verb, request.output); });
  verb->footer(
      "Exit code 1 with warnings.\n\n"
      "Example: sunder bind glove.glb --skeleton hand.urdf --map bones.json --fit -o bound.glb");
  return verb;
}

}  // namespace sunder::tools
