#include "tools/model/pose_argument.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/model/find_clip.h"
#include "tools/model/nearest_names.h"

namespace sunder::tools {
namespace {

/// Durations are shown with four digits, and whoever copies one means the end.
constexpr double kTimeTolerance = 1e-3;

std::optional<double> parse_time(std::string_view text) {
  if (text.ends_with('s')) text.remove_suffix(1);
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(seconds))
    return std::nullopt;
  return seconds;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

Result<PoseArgument> parse_pose(const std::string& text, const Character& character) {
  if (text == "rest") return PoseArgument{RestPose{}, "rest", ""};
  if (text == "bind") return PoseArgument{BindPose{}, "bind", ""};
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "'%s' is no pose; expected rest, bind or CLIP@TIME with seconds",
                           text.c_str());
  const std::string name = text.substr(0, at);
  const std::optional<double> seconds = parse_time(std::string_view(text).substr(at + 1));
  if (!seconds || *seconds < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "'%s': '%s' is no time; expected seconds, 0 or more", text.c_str(),
                           text.c_str() + at + 1);
  const std::optional<std::uint32_t> found = find_clip(character, name);
  if (!found)
    return Status::failure(StatusCode::not_found, kNone, "the model has no clip '%s'",
                           name.c_str());
  const Clip& clip = character.clips[*found];
  PoseArgument pose{ClipPose{*found, *seconds}, "'" + clip.name + "' at " + number(*seconds) + " s",
                    ""};
  if (*seconds > static_cast<double>(clip.duration) + kTimeTolerance)
    pose.remark = number(*seconds) + " s is beyond the end of clip '" + clip.name +
                  "', which lasts " + number(static_cast<double>(clip.duration)) +
                  " s; its last pose is taken";
  return pose;
}

std::string advice_on_pose(const std::string& text, const Character& character) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return {};
  const std::string name = text.substr(0, at);
  if (find_clip(character, name)) return {};
  std::vector<std::string> names;
  for (const Clip& clip : character.clips) names.push_back(clip.name);
  return name_advice(name, "clips", names);
}

}  // namespace sunder::tools
