#pragma once

#include <sunder/core/character.h>

namespace sunder::tools {

/// A soft, branching, bending thing to try tears on without any file: a potted cactus, made by
/// code, always the same.
///
/// Mesh "Cactus": one closed manifold surface of a few thousand points, two submeshes, a UV set
/// with seams, up to six influences a vertex, the morph target "Swell". Mesh "Pot": rigid, with
/// hard edges. Clip "Sway": 2 s, a loop. y is up, 1.8 m high, z to the front.
Character make_cactus();

}  // namespace sunder::tools
