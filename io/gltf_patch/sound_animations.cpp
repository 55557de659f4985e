#include "io/gltf_patch/sound_animations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sunder::gltf {
namespace {

// The tolerance of the Khronos validator.
constexpr double kKeyTolerance = 0.00769;

std::string interpolation_of(const Json& sampler) {
  const auto found = sampler.find("interpolation");
  return found == sampler.end() ? "LINEAR" : found->get<std::string>();
}

bool are_times(const std::vector<float>& values) {
  return values.front() >= 0.0f &&
         std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

bool is_sampler_sound(const Json& sampler, SoundAccessors& accessors) {
  const auto input = accessors.open(sampler["input"]), output = accessors.open(sampler["output"]);
  if (!input || !output || input->is_integer() || accessors.type(*input) != "SCALAR" ||
      accessors.has_stride(*input) || accessors.has_stride(*output))
    return false;
  if (!accessors.follows(SoundAccessors::Rule::times, *input, are_times) ||
      !accessors.is_finite(*output))
    return false;
  accessors.correct_bounds(input->index, true);
  accessors.correct_bounds(output->index, false);
  return interpolation_of(sampler) != "CUBICSPLINE" || input->count > 1;
}

/// The number of morph targets that a node's mesh has.
std::size_t target_count(const Json& node, const Json& document) {
  const auto mesh = node.find("mesh");
  if (mesh == node.end()) return 0;
  const Json& primitives = document["meshes"][mesh->get<std::size_t>()]["primitives"];
  if (primitives.empty() || !primitives[0].is_object()) return 0;
  const auto targets = primitives[0].find("targets");
  return targets == primitives[0].end() ? 0 : targets->size();
}

bool are_rotations_unit(const std::vector<float>& values, bool is_spline) {
  for (std::size_t row = 0; 4 * row + 3 < values.size(); ++row) {
    if (is_spline && row % 3 != 1) continue;
    double squared = 0;
    for (std::size_t i = 4 * row; i < 4 * row + 4; ++i)
      squared += static_cast<double>(values[i]) * static_cast<double>(values[i]);
    if (std::abs(std::sqrt(squared) - 1.0) > kKeyTolerance) return false;
  }
  return true;
}

bool is_channel_sound(const Json& channel, const Json& animation, const Json& document,
                      SoundAccessors& accessors) {
  const Json& samplers = animation["samplers"];
  const auto sampler_index = channel["sampler"].get<std::size_t>();
  if (sampler_index >= samplers.size()) return false;
  const Json& target = channel["target"];
  const auto node_at = target.find("node");
  const bool has_node = node_at != target.end();  // Without one, the channel is ignored.
  static const Json kNoNode = Json::object();
  const Json& node = has_node ? document["nodes"][node_at->get<std::size_t>()] : kNoNode;
  const auto& path = target["path"].get_ref<const std::string&>();
  const Json& sampler = samplers[sampler_index];
  const auto input = accessors.open(sampler["input"]), output = accessors.open(sampler["output"]);
  const std::string_view type = accessors.type(*output);
  const bool is_spline = interpolation_of(sampler) == "CUBICSPLINE";
  const bool is_share = !output->is_integer() || output->normalized;
  std::size_t expected = std::size_t{input->count} * (is_spline ? 3 : 1);
  if (path == "weights") {
    const std::size_t targets = target_count(node, document);
    if (type != "SCALAR" || !is_share) return false;
    return !has_node || (targets > 0 && output->count == expected * targets);
  }
  if (node.contains("matrix") || output->count != expected) return false;
  if (path != "rotation") return type == "VEC3" && !output->is_integer();
  if (type != "VEC4" || !is_share) return false;
  using Rule = SoundAccessors::Rule;
  return accessors.follows(
      is_spline ? Rule::spline_rotations : Rule::rotations, *output,
      [&](const std::vector<float>& values) { return are_rotations_unit(values, is_spline); });
}

}  // namespace

bool is_animation_sound(const Json& animation, const Json& document, SoundAccessors& accessors) {
  if (!animation.contains("channels") || !animation.contains("samplers") ||
      !animation["channels"].is_array() || animation["channels"].empty())
    return false;
  for (const Json& sampler : animation["samplers"])
    if (!is_sampler_sound(sampler, accessors)) return false;
  std::set<std::pair<std::size_t, std::string>> targets;
  for (const Json& channel : animation["channels"]) {
    if (!is_channel_sound(channel, animation, document, accessors)) return false;
    const Json& target = channel["target"];
    if (target.contains("node") &&
        !targets.emplace(target["node"].get<std::size_t>(), target["path"].get<std::string>())
             .second)
      return false;
  }
  return true;
}

}  // namespace sunder::gltf
