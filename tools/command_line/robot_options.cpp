#include <algorithm>
#include <array>
#include <sstream>
#include <string>

#include "core/operation/internal/field_ranges.h"
#include "io/robot/internal/option_ranges.h"
#include "tools/bind/place.h"
#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {
namespace {

constexpr const char* kGroup = "A robot";

/// Reads "bx,by,bz,tx,ty,tz".
bool parse_edge(const std::string& text, RobotTearRequest& robot) {
  std::array<double, 6> numbers{};
  std::size_t count = 0;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ','); ++count) {
    const std::optional<double> number = quantity_in(part, Quantity::length);
    if (!number || count == numbers.size() || !field::kCoordinate.holds(*number)) return false;
    numbers[count] = *number;
  }
  robot.base = Vec3d(numbers[0], numbers[1], numbers[2]);
  robot.tip = Vec3d(numbers[3], numbers[4], numbers[5]);
  return count == numbers.size() && !text.ends_with(',') && robot.base != robot.tip;
}

void add_blade(CLI::App& verb, RobotTearRequest& robot, CLI::Option* file) {
  verb.add_option("--blade", robot.link, "The link that carries the blade")
      ->type_name("LINK")
      ->group(kGroup)
      ->needs(file);
  verb.add_option_function<std::string>(
          "--edge",
          [&robot](const std::string& text) {
            if (!parse_edge(text, robot))
              throw CLI::ValidationError("--edge", "'" + text +
                                                       "': expected six numbers, "
                                                       "base and tip at two places");
          },
          "Base and tip of the blade in the link's frame: bx,by,bz,tx,ty,tz, metres")
      ->type_name("NUMBERS")
      ->group(kGroup)
      ->default_str("0,0,0,0,0,0.05")
      ->needs(file);
  takes(verb.add_option("--spacing", robot.spacing,
                        "Largest distance that base or tip moves between two blades, metres"),
        robot::kSpacing, Quantity::length)
      ->type_name("NUMBER")
      ->group(kGroup)
      ->capture_default_str()
      ->needs(file);
}

}  // namespace

CLI::Option* add_placed_robot(CLI::App& verb, RobotTearRequest& robot, const char* description) {
  CLI::Option* const file =
      verb.add_option("--robot", robot.robot, description)->type_name("FILE")->group(kGroup);
  add_blade(verb, robot, file);
  verb.add_option_function<std::string>(
          "--robot-place",
          [&robot](const std::string& text) {
            const auto place = parse_place(text);
            if (!place || std::ranges::count(text, ',') > 5)
              throw CLI::ValidationError("--robot-place",
                                         "'" + text + "': expected x,y,z[,roll,pitch,yaw]");
            robot.place = *place;
          },
          "Place of the robot in the model's space: x,y,z[,roll,pitch,yaw], metres and degrees; "
          "roll "
          "about the model's x, then pitch about its y, then yaw about its z, as URDF's rpy: "
          "0,1,0,0,90,0 turns what points along +z to +x")
      ->type_name("NUMBERS")
      ->group(kGroup)
      ->needs(file);
  return file;
}

CLI::Option* add_clip_speed(CLI::App& verb, RobotTearRequest& robot) {
  return takes(verb.add_option(
                   "--clip-speed", robot.clip_speed,
                   "Seconds by which the clip of --pose runs on per second of the motion"),
               robot::kClipSpeed)
      ->type_name("NUMBER")
      ->capture_default_str();
}

void add_robot(CLI::App& verb, RobotTearRequest& robot, const char* description) {
  CLI::Option* const file = add_placed_robot(verb, robot, description);
  verb.add_option("--trajectory", robot.trajectory,
                  "The robot's motion: CSV or JSON of times and joint values")
      ->type_name("FILE")
      ->group(kGroup)
      ->needs(file);
  add_clip_speed(verb, robot)->group(kGroup)->needs(file);
  verb.add_flag("--keep-limits", robot.clamps_to_limits,
                "Keep joints within their limits where the motion leaves them")
      ->group(kGroup)
      ->needs(file);
}

bool has_robot(const CLI::App& verb, const RobotTearRequest& robot, bool needs_blade) {
  if (verb.count("--robot") == 0) return false;
  if (robot.trajectory.empty() && (needs_blade || !robot.link.empty()))
    throw CLI::RequiredError("--trajectory (with --robot)");
  if (robot.link.empty() && needs_blade) throw CLI::RequiredError("--blade (with --robot)");
  if (robot.clip_speed > 0 && robot.pose.find('@') == std::string::npos)
    throw CLI::ValidationError("--clip-speed", "needs --pose CLIP@TIME");
  return true;
}

}  // namespace sunder::tools
