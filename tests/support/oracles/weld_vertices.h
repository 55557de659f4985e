#pragma once

#include <sunder/core/character.h>

namespace sunder::test {

/// Merges the vertices of each mesh that agree in all attributes, as common tools do.
/// @param tolerance  0: the attributes must be equal bit for bit; otherwise equal after rounding to
///         multiples of it, as in three.js's mergeVertices().
Character weld_vertices(const Character& character, float tolerance);

}  // namespace sunder::test
