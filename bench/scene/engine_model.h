#pragma once

#include <sunder/core/character.h>

#include <memory>

namespace sunder::bench {

/// A tube of 2 m along y, 1 m thick, from the rigs of the tests, with each triangle divided into
/// divisions x divisions: normals, tangents, texture coordinates with a seam, hard rims, 64 bones
/// and a clip in which all of them move. About 3,400 x divisions^2 vertices.
[[nodiscard]] std::shared_ptr<const Character> make_engine_model(int divisions);

}  // namespace sunder::bench
