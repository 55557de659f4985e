#pragma once

#include <sunder/binding/binding.h>

#include <span>
#include <string>
#include <vector>

namespace sunder::binding {

/// The index of a bone by its name. @param owner  "the rig", for the text of the failure.
/// @return not_found, with the nearest names.
[[nodiscard]] Result<Index> find_bone_named(const Skeleton& skeleton, const std::string& name,
                                            const char* owner);

/// Per bone of the model: the bone of the rig with which it is paired, by `pairs` or else by equal
/// names; kNone without one.
/// @return not_found; invalid_argument for a bone of the model in two pairs.
[[nodiscard]] Result<std::vector<Index>> rig_bones(const Skeleton& model, const Skeleton& rig,
                                                   std::span<const BonePair> pairs);

}  // namespace sunder::binding
