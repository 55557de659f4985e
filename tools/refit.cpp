#include "tools/refit.h"

#include <sunder/skinning/pose.h>

#include <utility>

#include "tools/history.h"

namespace sunder::tools {

PoseSetSpec pose_set_of(RefitOver over) {
  PoseSetSpec poses;
  if (over == RefitOver::range_of_motion) poses.clip_samples = 0;
  poses.range_of_motion = over != RefitOver::clips;
  return poses;
}

const char* refit_over_name(RefitOver over) {
  switch (over) {
    case RefitOver::clips: return "clips";
    case RefitOver::range_of_motion: return "range_of_motion";
    case RefitOver::both: return "both";
  }
  return "clips";
}

Result<std::optional<RefitOver>> choose_poses(std::shared_ptr<const Character> character,
                                              std::optional<RefitOver> asked) {
  const RefitOver over = asked.value_or(RefitOver::both);
  const auto poses = PoseSet::create(std::move(character), pose_set_of(over));
  if (poses) return std::optional(over);
  if (!asked && poses.error().code() == StatusCode::empty_input) return std::optional<RefitOver>();
  return poses.error();
}

std::vector<WeightsOperation> refits_of(const std::vector<Operation>& history, RefitOver over) {
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
    refit.refit.poses = pose_set_of(over);
    refits.push_back(std::move(refit));
    begin = end;
  }
  return refits;
}

}  // namespace sunder::tools
