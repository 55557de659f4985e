#pragma once

#include <sunder/core/character.h>

namespace sunder::test {

/// Merges the vertices of each mesh that agree in all attributes, as the tools do that users run on
/// files.
/// @param tolerance  0: the attributes agree bit for bit; otherwise they agree when rounded to
///                   multiples of it, as three.js's mergeVertices() compares them.
Character weld_vertices(const Character& character, float tolerance);

}  // namespace sunder::test
