#pragma once

#include <sunder/core/character.h>

namespace sunder::bench {

/// A rigged character with each triangle divided into divisions x divisions, for measurements on
/// large files. New vertices have interpolated positions, normals, texture coordinates and weights
/// (the four largest); tangents, colours, custom attributes and morph targets are left out. Clips
/// stay. @param divisions  >= 1.
[[nodiscard]] Character subdivide_skinned(const Character& character, int divisions);

}  // namespace sunder::bench
