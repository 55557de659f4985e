#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/command_line/options.h"
#include "tools/model/name_at.h"
#include "tools/tear/aimed_fields.h"
#include "tools/tear/aimed_option.h"

namespace sunder::tools {
namespace {

constexpr const char* kSlash = "--slash";
constexpr const char* kSever = "--sever";
constexpr const char* kPuncture = "--puncture";
constexpr const char* kWeld = "--weld";
constexpr const char* kSuture = "--suture";

/// An option that may be given several times, with one value each.
void add(CLI::App& verb, const char* name, const std::string& description) {
  verb.add_option_function<std::vector<std::string>>(
          name, [](const std::vector<std::string>&) {}, description)
      ->allow_extra_args(false)
      ->type_name("BONE[@SHARE][,FIELD=VALUE...]")
      ->group("Aimed operations");
}

void add_closing(CLI::App& verb, const char* name, const std::string& description) {
  verb.add_option_function<std::vector<std::string>>(
          name, [](const std::vector<std::string>&) {}, description)
      ->allow_extra_args(false)
      ->type_name("all|X/Y/Z[,FIELD=VALUE...]")
      ->group("Closing wounds");
}

/// "fields: from, radius": those besides the share, which follows the bone.
std::string fields_of(const char* option) {
  std::string text;
  for (const AimedField& field : aimed_fields(option + 2).fields)
    if (field.name != kShareField)
      text += (text.empty() ? "fields: " : ", ") + std::string(field.name);
  return text;
}

/// The direction that "+x" or "0.5/0/1" names; empty for another text.
std::optional<Vec3d> facing_in(const std::string& text) {
  static const std::map<std::string, Vec3d> kAxes = {{"+x", Vec3d(1, 0, 0)},
                                                     {"-x", Vec3d(-1, 0, 0)},
                                                     {"+z", Vec3d(0, 0, 1)},
                                                     {"-z", Vec3d(0, 0, -1)}};
  const auto axis = kAxes.find(text);
  if (axis != kAxes.end()) return axis->second;
  const std::optional<Vec3d> direction = direction_in(text);
  const bool is_level =
      direction && (direction->x() != 0 || direction->z() != 0) && direction->allFinite();
  return is_level ? std::optional(Vec3d(direction->x(), 0, direction->z())) : std::nullopt;
}

}  // namespace

void add_aimed_operations(CLI::App& verb) {
  add(verb, kSlash,
      "Tear a stroke on the limb of a bone, at a share of its length from 0 to 1 (0.5); " +
          fields_of(kSlash) +
          "; see docs/aim.md. Repeatable, as those below; applied in order, after --ops");
  add(verb, kSever,
      "Cut through the limb of a bone and nothing else, without a share at its joint; " +
          fields_of(kSever) +
          "; detach: take off what comes free, with hats, eyes and axes that move with it, or "
          "parts=none without them");
  add(verb, kPuncture, "Bore into the limb of a bone; " + fields_of(kPuncture));
  add_closing(verb, kSuture,
              "Sew wounds, after all tears: all, or the one nearest to a place; fields: reach, "
              "spacing (metres), stiffness (N/m), tension, strength (newtons). With --open the "
              "lips gape between the threads; docs/tear.md. Repeatable");
  add_closing(verb, kWeld,
              "Close wounds again, after all tears: all, or the one nearest to a place, as far "
              "along it as reach=METRES; docs/tear.md. Repeatable");
  verb.add_option(
          "--pose",
          "The pose for the options above and for --robot: rest, bind, or a clip at a time in "
          "seconds, Walk@0.5")
      ->type_name("POSE")
      ->default_str("rest")
      ->group("Aimed operations");
  verb.add_option(
          "--facing",
          "Which way the character faces, for from= of the options above: +x, -x, +z, -z or x/y/z; "
          "without it, as its rig tells")
      ->type_name("DIRECTION")
      ->default_str("as its rig tells; said if that is uncertain or not +z")
      ->group("Aimed operations");
}

void read_aimed_operations(const CLI::App& verb, TearRequest& request) {
  if (verb.count("--facing") > 0) {
    const std::string text = verb.get_option("--facing")->results().back();
    request.facing = facing_in(text);
    if (!request.facing)
      throw CLI::ValidationError("--facing", "'" + text +
                                                 "' is no direction; expected +x, -x, +z, -z or a "
                                                 "level direction such as 1/0/1");
  }
  std::optional<std::string> pose;
  if (verb.count("--pose") > 0) pose = verb.get_option("--pose")->results().back();
  std::map<std::string, std::size_t> read;
  for (const CLI::Option* const option : verb.parse_order()) {
    const std::string name = option->get_name();
    if (name != kSlash && name != kSever && name != kPuncture) continue;
    const std::string text = option->results().at(read[name]++);
    const auto aimed = parse_aimed_option(name.substr(2), text, pose);
    if (!aimed) throw CLI::ValidationError(name + " " + text, std::string(aimed.error().text()));
    request.aimed.push_back(*aimed);
  }
  for (const char* const name : {kSuture, kWeld}) {
    if (verb.count(name) == 0) continue;
    for (const std::string& text : verb.get_option(name)->results()) {
      const auto closing = parse_closing_option(name + 2, text, pose);
      const std::string option = name + (" " + text);
      if (!closing) throw CLI::ValidationError(option, std::string(closing.error().text()));
      request.closings.push_back({*closing, option});
    }
  }
  if (pose && request.aimed.empty() && request.closings.empty() && verb.count("--robot") == 0)
    throw CLI::ValidationError("--pose",
                               "needs --slash, --sever, --puncture, --suture, --weld or --robot");
}

}  // namespace sunder::tools
