#include "tools/pose_argument.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/nearest_names.h"

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

Status unknown_clip(const std::string& name, const Character& character) {
  std::vector<std::string> names;
  for (const Clip& clip : character.clips) names.push_back(clip.name);
  return Status::failure(StatusCode::not_found, kNone, "the model has no clip '%s'%s", name.c_str(),
                         offer_names(name, names).c_str());
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
  for (std::uint32_t i = 0; i < character.clips.size(); ++i) {
    const Clip& clip = character.clips[i];
    if (clip.name != name) continue;
    PoseArgument pose{ClipPose{i, *seconds}, "'" + name + "' at " + number(*seconds) + " s", ""};
    if (*seconds > static_cast<double>(clip.duration) + kTimeTolerance)
      pose.remark = number(*seconds) + " s is beyond the end of clip '" + name + "', which lasts " +
                    number(static_cast<double>(clip.duration)) + " s; its last pose is taken";
    return pose;
  }
  return unknown_clip(name, character);
}

}  // namespace sunder::tools
