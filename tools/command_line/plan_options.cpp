#include <string>

#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"
#include "tools/plan/plan_request.h"

namespace sunder::tools {
namespace {

constexpr NumberRange kPartSeconds = {
    .field = "the value", .least = 1e-3, .most = 3600, .unit = " s"};
constexpr NumberRange kLength = {.field = "the value", .least = 1e-6, .most = 1e6, .unit = " m"};
constexpr NumberRange kHeight = {.field = "the value", .least = 0, .most = 1e6, .unit = " m"};
constexpr NumberRange kRate = {.field = "the value", .least = 1, .most = 1e5, .unit = " per s"};
constexpr NumberRange kAcceleration = {.field = "the value", .least = 1e-6, .most = 1e9};

void add_timing(CLI::App& verb, PlanRequest& request) {
  verb.add_option("--pose", request.robot.pose,
                  "Pose of the model when the motion begins: rest, bind or CLIP@TIME")
      ->type_name("POSE")
      ->capture_default_str();
  add_clip_speed(verb, request.robot);
  const auto add = [&verb](const char* name, double& seconds, const char* text) {
    takes(verb.add_option(name, seconds, text), kPartSeconds, Quantity::time)
        ->type_name("SECONDS")
        ->capture_default_str();
  };
  add("--cut", request.timing.cut, "Duration of the cut");
  add("--approach", request.timing.approach, "Duration of the approach, before the cut");
  add("--retreat", request.timing.retreat, "Duration of the retreat, after the cut");
  verb.add_flag("--longer", request.timing.may_take_longer,
                "The cut may take longer, so that joints keep their speeds");
  takes(verb.add_option("--standoff", request.timing.standoff,
                        "Height of the tip above the surface at begin and end"),
        kHeight, Quantity::length)
      ->type_name("LENGTH")
      ->capture_default_str();
}

void add_curve(CLI::App& verb, PlanRequest& request) {
  CLI::Option* const curve =
      verb.add_option("--curve", request.curve, "JSON file: the curve on the surface, depth, angle")
          ->type_name("FILE");
  CLI::Option* const like =
      verb.add_option("--like", request.like,
                      "In place of a curve, a torn model: the wound that it has, by bones")
          ->type_name("FILE")
          ->excludes(curve);
  takes(verb.add_option("--like-depth", request.like_depth, "Depth of the blade for --like"),
        kLength, Quantity::length)
      ->type_name("LENGTH")
      ->capture_default_str()
      ->needs(like);
}

void add_outputs(CLI::App& verb, PlanRequest& request) {
  verb.add_option("-o,--output", request.robot.trajectory,
                  "The trajectory: CSV, for sunder tear --trajectory")
      ->type_name("FILE");
  CLI::Option* const tear =
      verb.add_option("--tear", request.tear, "The model with that tear")->type_name("FILE");
  verb.add_option("--picture", request.picture, "PNG of the wound, with the robot")
      ->type_name("FILE")
      ->needs(tear);
  verb.add_option("--report", request.report, "File for a JSON report")->type_name("FILE");
}

void add_score(CLI::App& verb, PlanRequest& request, CLI::Option* hand) {
  CLI::Option* const score =
      verb.add_option("--score", request.score,
                      "In place of a plan: how near to the curve a stroke was that was performed, "
                      "a trajectory of the robot or a log")
          ->type_name("FILE")
          ->excludes(hand)
          ->excludes("--output")
          ->excludes("--tear");
  takes(verb.add_option("--score-rate", request.score_rate, "Blades per second of that log"), kRate)
      ->type_name("NUMBER")
      ->needs(score);
}

/// What the options need of one another.
void check_together(const CLI::App& verb, const PlanRequest& request) {
  if (verb.count("--curve") + verb.count("--like") == 0)
    throw CLI::RequiredError("--curve or --like");
  if (!request.score && verb.count("--output") == 0) throw CLI::RequiredError("--output");
  if (!request.score && verb.count("--robot") + verb.count("--hand") == 0)
    throw CLI::RequiredError("--robot or --hand");
  if (verb.count("--robot") != 0 && request.robot.link.empty())
    throw CLI::RequiredError("--blade (with --robot)");
  if (request.robot.clip_speed > 0 && request.robot.pose.find('@') == std::string::npos)
    throw CLI::ValidationError("--clip-speed", "needs --pose CLIP@TIME");
  if (request.tear) check_output_format(verb, *request.tear);
}

}  // namespace

CLI::App* add_plan(CLI::App& app, PlanRequest& request) {
  CLI::App* const verb = app.add_subcommand(
      "plan", "Find the motion of a robot or a hand that makes a wound on a moving model");
  verb->add_option("MODEL", request.model, "The model")->type_name("FILE")->required();
  add_curve(*verb, request);
  CLI::Option* const robot =
      add_placed_robot(*verb, request.robot, "URDF file of the robot that carries the blade");
  CLI::Option* const hand =
      verb->add_option("--hand", request.hand,
                       "In place of a robot, a hand that moves freely: output, as URDF")
          ->type_name("FILE")
          ->excludes(robot);
  takes(verb->add_option("--hand-blade", request.hand_blade, "Length of the hand's blade"), kLength,
        Quantity::length)
      ->type_name("LENGTH")
      ->capture_default_str()
      ->needs(hand);
  add_timing(*verb, request);
  takes(verb->add_option("--tolerance", request.options.tolerance,
                         "Largest distance of lips and curve; default: 1 % of the length"),
        kLength, Quantity::length)
      ->type_name("LENGTH");
  takes(verb->add_option("--acceleration", request.options.maximum_acceleration,
                         "Largest acceleration of every joint, rad/s^2 or m/s^2; default: any"),
        kAcceleration)
      ->type_name("NUMBER");
  add_outputs(*verb, request);
  add_score(*verb, request, hand);
  add_model_reading(*verb, request.reading);
  add_budget(*verb, request.budget);
  verb->callback([&request, verb] { check_together(*verb, request); });
  verb->footer(
      "Exit code 1 if the curve cannot be made: what stops the blade, and the part that can.\n\n"
      "Example: sunder plan fox.glb --curve curve.json --robot arm.urdf --blade scalpel --pose "
      "Walk@0.4 --clip-speed 1 -o plan.csv --tear torn.glb");
  return verb;
}

}  // namespace sunder::tools
