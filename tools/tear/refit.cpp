#include "tools/tear/refit.h"

#include <sunder/robot/robot_limits.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "tools/model/history.h"
#include "tools/model/robot_joints.h"

namespace sunder::tools {
namespace {

constexpr const char kClips[] = "clips";
constexpr const char kRangeOfMotion[] = "range_of_motion";

/// Takes "=FACTOR" from the end of a part; 1 if there is none.
/// @return false if what follows the last "=" is no factor.
bool take_factor(std::string& part, double& factor) {
  factor = 1;
  const std::size_t at = part.rfind('=');
  if (at == std::string::npos) return true;
  const char* const end = part.data() + part.size();
  const auto read = std::from_chars(part.data() + at + 1, end, factor);
  const bool is_factor =
      read.ec == std::errc() && read.ptr == end && std::isfinite(factor) && factor >= 0;
  if (is_factor) part.resize(at);
  return is_factor;
}

void append_part(std::string& text, const std::string& part, double factor) {
  if (!text.empty()) text += ',';
  text += part;
  if (factor == 1) return;
  std::ostringstream number;
  number << '=' << factor;
  text += number.str();
}

}  // namespace

Result<RefitOptions> parse_refit_over(const std::string& text) {
  RefitOptions options;
  bool has_clips = false;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::string as_given = part;
    double factor = 1;
    const bool has_factor = take_factor(part, factor);
    if (has_factor && part == kRangeOfMotion) {
      options.poses.range_of_motion = true;
      options.importance.range_of_motion = factor;
    } else if (has_factor && part == kClips) {
      has_clips = true;
      options.importance.clips = factor;
    } else if (has_factor && part.starts_with("clips:") && part.size() > 6) {
      has_clips = true;
      options.importance.of_clip.push_back({part.substr(6), factor});
    } else {
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "'%.80s' is none of clips, clips:NAME and range_of_motion, each with "
                             "or without =FACTOR",
                             as_given.c_str());
    }
  }
  if (!has_clips) options.poses.clip_samples = 0;
  if (has_clips || options.poses.range_of_motion) return options;
  return Status::failure(StatusCode::invalid_argument, kNone, "no poses are named");
}

std::string refit_over_text(const RefitOptions& options) {
  std::string text;
  if (options.poses.clip_samples > 0) append_part(text, kClips, options.importance.clips);
  for (const RefitImportance::OfClip& of : options.importance.of_clip)
    append_part(text, "clips:" + of.clip, of.factor);
  if (options.poses.range_of_motion || !options.poses.joint_limits.empty())
    append_part(text, kRangeOfMotion, options.importance.range_of_motion);
  return text;
}

Result<std::optional<RefitOptions>> choose_refit(const Character& character,
                                                 const std::optional<RefitOptions>& asked) {
  RefitOptions options;
  options.poses.range_of_motion = true;
  if (asked) options = *asked;
  const Status status = PoseSet::check(character, options.poses);
  if (status) return std::optional(std::move(options));
  if (!asked && status.code() == StatusCode::empty_input) return std::optional<RefitOptions>();
  return status;
}

Status limit_range_of_motion(const std::filesystem::path& urdf, const Character& character,
                             RefitOptions& options) {
  const Result<Robot> robot = load_joints(urdf);
  if (!robot) return robot.error();
  const Result<std::vector<JointLimit>> limits = pose_limits_of(*robot);
  if (!limits) return limits.error();
  options.poses.joint_limits.clear();
  const std::vector<Bone>& bones = character.skeleton.bones;
  for (JointLimit limit : *limits) {
    const auto bone = std::ranges::find(bones, robot->links[limit.bone].name, &Bone::name);
    if (bone == bones.end()) continue;
    limit.bone = static_cast<std::uint32_t>(bone - bones.begin());
    options.poses.joint_limits.push_back(limit);
  }
  if (options.poses.joint_limits.empty())
    return Status::failure(StatusCode::not_found, kNone,
                           "no bone of the model has the name of a link that the robot turns");
  options.poses.range_of_motion = false;
  return {};
}

std::vector<WeightsOperation> refits_of(const std::vector<Operation>& history,
                                        const RefitOptions& options) {
  const std::vector<PointsOfOperation> points = points_of_history(history);
  const auto waits = [&](std::size_t i) {
    return points[i].are_there && points[i].weights.policy == WeightPolicy::refit &&
           !points[i].are_reweighed;
  };
  std::vector<WeightsOperation> refits;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() && waits(end) && points[end].weights == points[begin].weights) ++end;
    if (end == begin) {
      ++begin;
      continue;
    }
    WeightsOperation refit;
    refit.first_operation = static_cast<std::uint32_t>(begin);
    refit.operation_count = static_cast<std::uint32_t>(end - begin);
    refit.weights = points[begin].weights;
    refit.refit = options;
    refits.push_back(std::move(refit));
    begin = end;
  }
  return refits;
}

}  // namespace sunder::tools
