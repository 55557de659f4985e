#include "tools/model/named_poses.h"

#include <sunder/aim/aim.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "core/internal/find_named.h"
#include "tools/model/history.h"
#include "tools/model/model_check.h"
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

std::string advice_on_clip(const std::string& name, const Character& character) {
  return find_clip(character, name) ? std::string()
                                    : name_advice(name, "clips", names_of(character.clips));
}

}  // namespace

std::string advice_on_names(const PoseSpec& spec, const Character& character) {
  if (const auto* const pose = std::get_if<ClipPose>(&spec)) {
    const auto* const name = std::get_if<std::string>(&pose->clip);
    return name != nullptr ? advice_on_clip(*name, character) : std::string();
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
  if (!advice.empty() || has_bone) return advice;
  return is_static(character) ? "; the model is static: no clips, and no skin of several bones"
                              : "; `sunder info MODEL --bones` lists the bones";
}

std::string advice_on_names(const RefitOptions& refit, const Character& character) {
  for (const RefitImportance::OfClip& of : refit.importance.of_clip) {
    std::string text = advice_on_clip(of.clip, character);
    if (!text.empty()) return text;
  }
  return {};
}

}  // namespace sunder::tools
