#include <sunder/aim/aim.h>

#include <string>
#include <vector>

#include "core/internal/nearest_names.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

Status unknown(const Skeleton& skeleton, std::string_view name) {
  std::vector<std::string> names;
  for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
  const std::string wanted(name);
  const std::string near = listed_names(nearest_names(wanted, names));
  if (near.empty())
    return Status::failure(StatusCode::not_found, kNone,
                           "no bone is named '%.60s', and none of the %zu names is like it",
                           wanted.c_str(), names.size());
  return Status::failure(StatusCode::not_found, kNone, "no bone is named '%.60s'; did you mean %s?",
                         wanted.c_str(), near.c_str());
}

Result<std::uint32_t> find(const Skeleton& skeleton, std::string_view name) {
  const auto& bones = skeleton.bones;
  Index found = kNone;
  for (Index i = 0; i < bones.size(); ++i)
    if (bones[i].name == name) return i;
  for (Index i = 0; i < bones.size(); ++i) {
    if (without_namespace(bones[i].name) != name) continue;
    if (found != kNone)
      return Status::failure(StatusCode::invalid_argument, i,
                             "'%.60s' may be the bone '%.60s' or '%.60s'; give the whole name",
                             std::string(name).c_str(), bones[found].name.c_str(),
                             bones[i].name.c_str());
    found = i;
  }
  if (found == kNone) return unknown(skeleton, name);
  return found;
}

}  // namespace

Result<std::uint32_t> find_bone(const Skeleton& skeleton, std::string_view name) {
  return or_out_of_memory([&] { return find(skeleton, name); });
}

}  // namespace sunder
