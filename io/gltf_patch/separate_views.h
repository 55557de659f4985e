#pragma once

#include <vector>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

/// Gives every use its own description of the same bytes where glTF requires it: an accessor and a
/// buffer view have one kind of use, a view of several vertex attributes has a stride, and a view's
/// `target` fits its use. No data is copied.
/// @param document  follows enforce_schema().
void separate_views(Json& document);

/// One flag per accessor: something of the core format refers to it.
[[nodiscard]] std::vector<bool> used_accessors(Json& document);

}  // namespace sunder::gltf
