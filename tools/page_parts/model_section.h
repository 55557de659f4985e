#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include <span>
#include <string>
#include <vector>

#include "tools/page_parts/data_arrays.h"

namespace sunder::tools {

/// A slot of a skin as the page moves it: model_from_bind = model_from_bone[source_bone] *
/// bone_from_bind, or bone_from_bind alone without such a bone.
struct DrivenSlot {
  Index source_bone = kNone;
  Affine3d bone_from_bind = Affine3d::Identity();
};

/// Every bone moves itself.
[[nodiscard]] std::vector<Index> own_bones(const Skeleton& skeleton);

/// Twelve doubles per matrix, column by column.
[[nodiscard]] Json matrices_json(std::span<const Affine3d> matrices, DataArrays& arrays);

/// The slots of all skins of a character, back to back, moved by the bones of the source. A bone
/// without a bone of the source follows its nearest ancestor that has one, as both stood at bind.
/// @param source_bone  one per bone of `character`.
/// @return the failures of bind_pose().
[[nodiscard]] Result<std::vector<DrivenSlot>> driven_slots(const Character& character,
                                                           const std::vector<Index>& source_bone);

/// Describes the meshes, morph targets and skins of a character.
/// @return limit_exceeded beyond 65,535 slots or 255 influences of a vertex.
[[nodiscard]] Result<Json> model_section(const Character& character, const std::string& title,
                                         const std::vector<Index>& source_bone, DataArrays& arrays);

}  // namespace sunder::tools
