#pragma once

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// Leaves out of a document what nothing in it uses: accessors, buffer views, the bytes of the BIN
/// chunk on which no accessor lies; and meshes and skins that nodes of the source use, but no node
/// of the draft. What is left decodes to the same values.
///
/// Extensions that we do not know may refer to entries by number. If there is one, all entries of
/// the source that are still used keep their numbers, new ones take the place of unused ones, and
/// what any number in the extension may refer to is kept.
/// @param draft  follows the schema; it was made from `source`.
void leave_out_unused(GlbDraft& draft, const SourceDocument& source);

}  // namespace sunder::gltf
