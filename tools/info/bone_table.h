#pragma once

#include <string>
#include <vector>

#include "tools/messages/json.h"
#include "tools/messages/lines.h"
#include "tools/model/bone_extents.h"

namespace sunder::tools {

/// One object per bone of the skeleton, in its order.
[[nodiscard]] Json bone_tree_json(const Skeleton& skeleton, const std::vector<BoneExtent>& extents);

/// The member "bone_tree" of an info as a table: parents before children, which are indented.
[[nodiscard]] Lines bone_tree_text(const Json& info);

}  // namespace sunder::tools
