#include "io/operation_log/read_weights.h"

#include "io/operation_log/read_pose.h"
#include "operation/internal/field_ranges.h"

namespace sunder::operation_log {
namespace {

constexpr std::uint32_t kMaximumClipSamples = 65'536;  ///< As PoseSetSpec.

WeightPolicy read_policy(const Place& place) {
  const std::string name = read_name(place);
  if (name == "pose_exact") return WeightPolicy::pose_exact;
  if (name == "refit") return WeightPolicy::refit;
  if (name == "exact") return WeightPolicy::exact;
  if (name != "barycentric")
    place.fail(
        StatusCode::unsupported_feature,
        "unknown policy '" + name + "'; expected 'barycentric', 'pose_exact', 'refit' or 'exact'");
  return WeightPolicy::barycentric;
}

JointLimit read_joint_limit(const Place& place) {
  place.check_fields({"bone", "axis", "lower", "upper"});
  JointLimit limit;
  limit.bone = read_integer(place.at("bone"), "a bone's index");
  limit.axis = read_direction(place.at("axis"), "axis");
  limit.lower = read_number(place.at("lower"));
  limit.upper = read_number(place.at("upper"));
  if (limit.lower > limit.upper) place.malformed("'lower' is above 'upper'");
  return limit;
}

template <class Element, Element read_one(const Place&)>
std::vector<Element> read_list(const Place& place) {
  const std::size_t count = read_array(place, "an array").size();
  std::vector<Element> list;
  list.reserve(count);
  for (std::size_t i = 0; i < count; ++i) list.push_back(read_one(place.at(i)));
  return list;
}

PoseSetSpec read_pose_set(const Place& place) {
  place.check_fields({"clip_samples", "range_of_motion", "joint_limits", "poses"});
  PoseSetSpec poses;
  const auto read_samples = [](const Place& samples) {
    return read_integer(samples, "samples a clip", 0, kMaximumClipSamples);
  };
  read_if_given(place, "clip_samples", read_samples, poses.clip_samples);
  read_if_given(place, "range_of_motion", read_bool, poses.range_of_motion);
  read_if_given(place, "joint_limits", read_list<JointLimit, read_joint_limit>, poses.joint_limits);
  read_if_given(place, "poses", read_list<PoseSpec, read_pose>, poses.poses);
  return poses;
}

RefitImportance::OfClip read_importance_of_clip(const Place& place) {
  place.check_fields({"clip", "factor"});
  return {read_name(place.at("clip")), NumberIn{field::importance("factor")}(place.at("factor"))};
}

RefitImportance read_importance(const Place& place) {
  place.check_fields({"clips", "of_clip", "range_of_motion", "poses"});
  RefitImportance importance;
  read_if_given(place, "clips", NumberIn{field::importance("clips")}, importance.clips);
  read_if_given(place, "of_clip", read_list<RefitImportance::OfClip, read_importance_of_clip>,
                importance.of_clip);
  read_if_given(place, "range_of_motion", NumberIn{field::importance("range_of_motion")},
                importance.range_of_motion);
  read_if_given(place, "poses", NumberIn{field::importance("poses")}, importance.poses);
  return importance;
}

double read_bound(const Place& place) {
  if (place.value.is_number() && place.value.get<double>() == 0) return 0;
  return NumberIn{field::kBound}(place);
}

RefitOptions read_refit(const Place& place) {
  place.check_fields({"poses", "importance", "bound", "moves_bind", "coupled", "smoothness"});
  RefitOptions refit;
  read_if_given(place, "poses", read_pose_set, refit.poses);
  read_if_given(place, "importance", read_importance, refit.importance);
  read_if_given(place, "bound", read_bound, refit.bound);
  read_if_given(place, "moves_bind", read_bool, refit.moves_bind);
  read_if_given(place, "coupled", read_bool, refit.is_coupled);
  read_if_given(place, "smoothness", NumberIn{field::kSmoothness}, refit.smoothness);
  return refit;
}

}  // namespace

WeightOptions read_weight_options(const Place& place) {
  place.check_fields({"policy", "influences"});
  WeightOptions options;
  read_if_given(place, "policy", read_policy, options.policy);
  const auto read_influences = [](const Place& influences) {
    return read_integer(influences, "influences, 0 for all", 0, kNone);
  };
  read_if_given(place, "influences", read_influences, options.maximum_influences);
  if (options.policy == WeightPolicy::exact && options.maximum_influences != 0)
    place.at("influences")
        .malformed("the policy 'exact' keeps all influences: leave this out or set it to 0");
  return options;
}

WeightsOperation read_weights(const Place& place) {
  place.check_fields({"op", "first", "count", "weights", "pose", "refit"});
  WeightsOperation operation;
  const auto read_first = [](const Place& first) {
    return read_integer(first, "an operation's index");
  };
  read_if_given(place, "first", read_first, operation.first_operation);
  read_if_given(place, "count", read_operation_count, operation.operation_count);
  operation.weights = read_weight_options(place.at("weights"));
  if (place.has("pose") && operation.weights.policy != WeightPolicy::pose_exact)
    place.at("pose").malformed("only the policy 'pose_exact' uses a pose");
  if (place.has("refit") && operation.weights.policy != WeightPolicy::refit)
    place.at("refit").malformed("only the policy 'refit' has options of a fit");
  read_if_given(place, "pose", read_pose, operation.pose);
  read_if_given(place, "refit", read_refit, operation.refit);
  return operation;
}

std::uint32_t read_operation_count(const Place& place) {
  return read_integer(place, "how many operations", 1);
}

}  // namespace sunder::operation_log
