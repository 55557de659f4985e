#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/command_line/options.h"
#include "tools/tear/aimed_option.h"

namespace sunder::tools {
namespace {

constexpr const char* kSlash = "--slash";
constexpr const char* kSever = "--sever";
constexpr const char* kPuncture = "--puncture";

/// An option that may be given several times, with one value each.
void add(CLI::App& verb, const char* name, const char* type, const char* description) {
  verb.add_option_function<std::vector<std::string>>(
          name, [](const std::vector<std::string>&) {}, description)
      ->allow_extra_args(false)
      ->type_name(type)
      ->group("Aimed operations");
}

}  // namespace

void add_aimed_operations(CLI::App& verb) {
  add(verb, kSlash, "BONE[@SHARE][,FIELD=VALUE...]",
      "Tear a stroke on the limb of a bone, at a share of its length from 0 to 1 (0.5); fields: "
      "from, "
      "length, turn, depth, width, layers, wall_depth, wall_material, lip_roll; see docs/aim.md. "
      "Repeatable, as those "
      "below; applied in order, after --ops");
  add(verb, kSever, "BONE[@SHARE][,FIELD=VALUE...]",
      "Cut through the limb of a bone and nothing else, without a share at its joint; fields: "
      "tilt, from, caps, cap_material");
  add(verb, kPuncture, "BONE[@SHARE][,FIELD=VALUE...]",
      "Bore into the limb of a bone; fields: from, radius, through, depth, wall, "
      "wall_material, chord_tolerance");
  verb.add_option(
          "--pose",
          "The pose for the options above and for --robot: rest, bind, or a clip at a time in "
          "seconds, Walk@0.5")
      ->type_name("POSE")
      ->default_str("rest")
      ->group("Aimed operations");
}

void read_aimed_operations(const CLI::App& verb, TearRequest& request) {
  std::optional<std::string> pose;
  if (verb.count("--pose") > 0) pose = verb.get_option("--pose")->results().back();
  std::map<std::string, std::size_t> read;
  for (const CLI::Option* const option : verb.parse_order()) {
    const std::string name = option->get_name();
    if (name != kSlash && name != kSever && name != kPuncture) continue;
    const std::string text = option->results().at(read[name]++);
    const auto operation = parse_aimed_option(name.substr(2), text, pose);
    if (!operation)
      throw CLI::ValidationError(name + " " + text, std::string(operation.error().text()));
    request.aimed.push_back({*operation, name + " " + text});
  }
  if (pose && request.aimed.empty() && verb.count("--robot") == 0)
    throw CLI::ValidationError("--pose", "needs --slash, --sever, --puncture or --robot");
}

}  // namespace sunder::tools
