#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/operation/internal/view_sides.h"
#include "tools/command_line/options.h"

namespace sunder::tools {
namespace {

constexpr int kLeastPixels = 16, kMostPixels = 8192;

/// Numbers with one separator between two of them.
template <class Number, std::size_t N>
std::optional<std::array<Number, N>> parse_numbers(std::string_view text, char separator) {
  std::array<Number, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (i + 1 == N) break;
    if (text.empty() || text.front() != separator) return std::nullopt;
    text.remove_prefix(1);
  }
  return text.empty() ? std::optional(numbers) : std::nullopt;
}

std::optional<Vec3d> parse_side(const std::string& text) {
  for (const NamedSide& known : kViewSides)
    if (text == known.name) return known.towards_viewer();
  const auto numbers = parse_numbers<double, 3>(text, ',');
  if (!numbers) return std::nullopt;
  const Vec3d direction((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  if (!direction.allFinite() || !(direction.norm() > 1e-9 && direction.norm() < 1e9))
    return std::nullopt;
  return direction;
}

std::optional<PictureSize> parse_size(const std::string& text) {
  const auto numbers = parse_numbers<int, 2>(text, 'x');
  if (!numbers) return std::nullopt;
  for (const int pixels : *numbers)
    if (pixels < kLeastPixels || pixels > kMostPixels) return std::nullopt;
  return PictureSize{(*numbers)[0], (*numbers)[1]};
}

/// An option whose text is converted by `parse`, which gives nothing for a wrong one.
template <class Value>
CLI::Option* add_parsed(CLI::App& verb, const char* name, Value& value,
                        std::optional<Value> (*parse)(const std::string&), const char* expected,
                        const char* description) {
  return verb.add_option_function<std::string>(
      name,
      [&value, parse, name, expected](const std::string& text) {
        const std::optional<Value> parsed = parse(text);
        if (!parsed) throw CLI::ValidationError(name, "'" + text + "': expected " + expected);
        value = *parsed;
      },
      description);
}

}  // namespace

CLI::App* add_picture(CLI::App& app, PictureRequest& request) {
  CLI::App* const verb =
      app.add_subcommand("picture", "Draw a model in a pose, and what operations would do to it");
  verb->add_option("MODEL", request.model, "Model file, as for `sunder info`")
      ->required()
      ->type_name("FILE");
  verb->add_option("-o,--output", request.output, "File for the picture, PNG")
      ->required()
      ->type_name("FILE");
  verb->add_option("--pose", request.pose,
                   "rest, bind, or CLIP@TIME with a time in seconds; default: the pose of the last "
                   "operation, or rest")
      ->type_name("POSE");
  verb->add_option("--joints", request.joints,
                   "Pose of a robot: NAME=VALUE, radians or metres, separated by commas; other "
                   "joints are at rest")
      ->type_name("VALUES")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes("--pose");
  add_parsed(*verb, "--from", request.from, parse_side,
             "front, back, left, right, top, bottom or a direction x,y,z of some length",
             "Side from which it is seen: front (+Z), back, left (+X), right, top, bottom, or the "
             "direction x,y,z towards the eye")
      ->type_name("SIDE")
      ->default_str("front");
  verb->add_option("--bone", request.bone,
                   "Bone whose limb fills the frame: what it and the bones below it move")
      ->type_name("NAME");
  add_parsed(*verb, "--size", request.size, parse_size, "WIDTHxHEIGHT, each from 16 to 8192 pixels",
             "Size in pixels")
      ->type_name("WIDTHxHEIGHT")
      ->default_str("1280x960");
  verb->add_flag("--axes", request.with_axes, "Draw the axes X, Y and Z in the corner");
  verb->add_flag("--grid", request.with_grid, "Draw a grid on the ground; stderr has its spacing");
  verb->add_flag("--bones", request.with_bones, "Draw the bones, with names where there is room");
  verb->add_option("--ops", request.operations,
                   "Operation log: draws its blades, planes and bores; nothing is torn")
      ->type_name("FILE");
  const auto robot = std::make_shared<RobotTearRequest>();  // lives as long as the options
  add_robot(
      *verb, *robot,
      "Robot, URDF, that stands beside the model: at rest, or at the end of --trajectory; with "
      "--blade its way is drawn");
  verb->callback([&request, verb, robot] {
    if (request.pose) robot->pose = *request.pose;
    if (has_robot(*verb, *robot, false)) request.robot = *robot;
  });
  add_model_reading(*verb, request.reading);
  add_budget_of_operations(*verb, request.budget);
  verb->footer(
      "Exit code 1 if something asked for could not be drawn; stderr says what.\n\n"
      "Example: sunder picture fox.glb -o fox.png --pose Walk@0.4 --from left --ops ops.json");
  return verb;
}

}  // namespace sunder::tools
