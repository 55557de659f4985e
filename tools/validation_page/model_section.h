#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include <string>
#include <vector>

#include "tools/validation_page/data_arrays.h"

namespace sunder::tools {

/// A slot of a skin as the page moves it: model_from_bind = model_from_bone[source_bone] *
/// bone_from_bind, or bone_from_bind alone without such a bone.
struct DrivenSlot {
  Index source_bone = kNone;
  Affine3d bone_from_bind = Affine3d::Identity();
};

/// The slots of all skins of a character, back to back, moved by the bones of the source. A bone
/// without a bone of the source follows its nearest ancestor that has one, as both stood at bind.
/// @param source_bone  one per bone of `character`.
/// @return the failures of bind_pose().
[[nodiscard]] Result<std::vector<DrivenSlot>> driven_slots(const Character& character,
                                                           const std::vector<Index>& source_bone);

/// Describes the meshes and skins of a character, with morph targets applied as at rest.
/// @return limit_exceeded beyond 65,536 slots or 255 influences of a vertex.
[[nodiscard]] Result<Json> model_section(const Character& character, const std::string& title,
                                         const std::vector<Index>& source_bone, DataArrays& arrays);

}  // namespace sunder::tools
