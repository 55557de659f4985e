#include "pipeline/binding/bone_pairs.h"

#include <map>

#include "core/internal/nearest_names.h"

namespace sunder::binding {

Result<Index> find_bone_named(const Skeleton& skeleton, const std::string& name,
                              const char* owner) {
  std::vector<std::string> names;
  for (Index i = 0; i < skeleton.bones.size(); ++i) {
    if (skeleton.bones[i].name == name) return i;
    names.push_back(skeleton.bones[i].name);
  }
  const std::string near = listed_names(nearest_names(name, names));
  if (near.empty())
    return Status::failure(StatusCode::not_found, kNone,
                           "no bone of %s is named '%.60s', and none of its %zu names is like it",
                           owner, name.c_str(), names.size());
  return Status::failure(StatusCode::not_found, kNone,
                         "no bone of %s is named '%.60s'; did you mean %s?", owner, name.c_str(),
                         near.c_str());
}

Result<std::vector<Index>> rig_bones(const Skeleton& model, const Skeleton& rig,
                                     std::span<const BonePair> pairs) {
  std::vector<Index> paired(model.bones.size(), kNone);
  for (Index i = 0; i < pairs.size(); ++i) {
    const Result<Index> of_model = find_bone_named(model, pairs[i].model, "the model");
    if (!of_model) return of_model.error();
    const Result<Index> of_rig = find_bone_named(rig, pairs[i].rig, "the rig");
    if (!of_rig) return of_rig.error();
    if (paired[*of_model] != kNone)
      return Status::failure(StatusCode::invalid_argument, i, "bone '%.80s' is mapped twice",
                             pairs[i].model.c_str());
    paired[*of_model] = *of_rig;
  }
  std::map<std::string, Index> rig_bone;
  for (Index i = 0; i < rig.bones.size(); ++i) rig_bone[rig.bones[i].name] = i;
  for (Index i = 0; i < paired.size(); ++i) {
    if (paired[i] != kNone) continue;
    const auto alike = rig_bone.find(model.bones[i].name);
    if (alike != rig_bone.end()) paired[i] = alike->second;
  }
  return paired;
}

}  // namespace sunder::binding
