#pragma once

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// The faces of walls and caps that go when lips are welded, ascending: the part of a wall that
/// hangs from such a lip, the whole of a cap that closes it, and what hangs from these alone.
/// @param half_edges  of lips, on the side of the skin.
[[nodiscard]] ScratchVector<Index> fillings_at_lips(std::span<const Index> half_edges,
                                                    const SurfaceEditor& editor);

}  // namespace sunder::tear
