#include "tools/model/named_poses.h"

#include <sunder/aim/aim.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "tools/model/history.h"
#include "tools/model/name_advice.h"

namespace sunder::tools {
namespace {

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

/// Empty if the name is among them.
std::string advice(const std::string& name, const char* kind, const std::vector<std::string>& all) {
  const bool is_there = std::ranges::find(all, name) != all.end();
  return is_there ? std::string() : name_advice(name, kind, all);
}

}  // namespace

std::string advice_on_names(const PoseSpec& spec, const Character& character) {
  if (const auto* const pose = std::get_if<ClipPose>(&spec)) {
    const auto* const name = std::get_if<std::string>(&pose->clip);
    return name != nullptr ? advice(*name, "clips", names_of(character.clips)) : std::string();
  }
  const auto* const bones = std::get_if<BonesPose>(&spec);
  if (bones == nullptr) return {};
  for (const BonesPose::Bone& bone : bones->bones) {
    std::string text = advice(bone.name, "bones", names_of(character.skeleton.bones));
    if (!text.empty()) return text;
  }
  return {};
}

std::string advice_on_names(const Operation& operation, const Character& character) {
  for (const PoseSpec& spec : pose_specs_of(operation)) {
    std::string text = advice_on_names(spec, character);
    if (!text.empty()) return text;
  }
  return {};
}

std::string advice_on_names(const AimedOperation& operation, const Character& character) {
  const PoseSpec pose = std::visit([](const auto& of) { return of.pose; }, operation);
  const std::string advice = advice_on_names(pose, character);
  const bool has_bone = std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.place; })
          return static_cast<bool>(find_bone(character.skeleton, of.place.bone));
        return true;
      },
      operation);
  return advice.empty() && !has_bone ? "; `sunder info MODEL --bones` lists the bones" : advice;
}

std::string advice_on_names(const RefitOptions& refit, const Character& character) {
  for (const RefitImportance::OfClip& of : refit.importance.of_clip) {
    std::string text = advice(of.clip, "clips", names_of(character.clips));
    if (!text.empty()) return text;
  }
  return {};
}

}  // namespace sunder::tools
