#include "tools/model/pose_argument.h"

#include <optional>
#include <string_view>

#include "core/internal/find_named.h"
#include "core/operation/internal/names.h"
#include "tools/messages/printed.h"
#include "tools/model/name_at.h"
#include "tools/model/named_poses.h"
#include "tools/model/quantity.h"

namespace sunder::tools {
namespace {

/// Durations are shown with four digits, and whoever copies one means the end.
constexpr double kTimeTolerance = 1e-3;

/// Seconds, 0 or more; empty for other texts.
std::optional<double> parse_time(std::string_view text) {
  const std::optional<double> seconds = quantity_in(text, Quantity::time);
  return seconds && *seconds >= 0 ? seconds : std::nullopt;
}

}  // namespace

Result<PoseArgument> parse_pose(const std::string& text, const Character& character) {
  if (text == kPoseName<RestPose>) return PoseArgument{RestPose{}, text, ""};
  if (text == kPoseName<BindPose>) return PoseArgument{BindPose{}, text, ""};
  const auto [name, time] = split_name_at(text);
  if (!time)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "'%s' is no pose; expected rest, bind or CLIP@TIME with seconds",
                           text.c_str());
  const std::optional<double> seconds = parse_time(*time);
  if (!seconds)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "'%s': '%s' is no time; expected seconds, 0 or more", text.c_str(),
                           time->c_str());
  const std::optional<std::uint32_t> found = find_clip(character, name);
  if (!found)
    return Status::failure(StatusCode::not_found, kNone, "the model has no clip '%s'",
                           name.c_str());
  const Clip& clip = character.clips[*found];
  PoseArgument pose{ClipPose{*found, *seconds},
                    printed("'%s' at %.4g s", clip.name.c_str(), *seconds), ""};
  if (*seconds > static_cast<double>(clip.duration) + kTimeTolerance)
    pose.remark =
        printed("%.4g s is beyond the end of clip '%s', which lasts %.4g s; its last pose is taken",
                *seconds, clip.name.c_str(), static_cast<double>(clip.duration));
  return pose;
}

std::string advice_on_pose(const std::string& text, const Character& character) {
  const auto [name, time] = split_name_at(text);
  if (!time || find_clip(character, name)) return {};
  return advice_on_names(PoseSpec(ClipPose{name}), character);
}

}  // namespace sunder::tools
