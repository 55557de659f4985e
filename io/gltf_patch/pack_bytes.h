#pragma once

#include <set>

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Removes the bytes of the BIN chunk on which no buffer view's accessors lie, and moves views and
/// accessors accordingly. The other bytes stay as they are, in their order. Up to three bytes stay
/// in a gap, because all data keeps its alignment; more stay between the elements of a view with a
/// stride.
/// @param draft  follows the schema; all its accessors and views are used.
/// @param whole_views  views of which every byte is kept, and their alignment to eight bytes.
void pack_bytes(GlbDraft& draft, const std::set<std::size_t>& whole_views);

}  // namespace sunder::gltf
