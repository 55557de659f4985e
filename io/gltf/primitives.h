#pragma once

#include <sunder/core/mesh.h>

#include <string>
#include <vector>

#include "io/gltf/reading.h"

namespace sunder::gltf {

/// Primitives of one glTF mesh on the same vertices; they become the submeshes of one core mesh.
struct PrimitiveGroup {
  std::vector<std::uint32_t> primitives;  ///< In the mesh's primitives.
};

/// Sorts a mesh's primitives by their vertices. Those without triangles or positions are left out,
/// and noted.
[[nodiscard]] std::vector<PrimitiveGroup> group_primitives(Reading& reading, const Cursor& mesh);

struct ReadTriangles {
  std::vector<Triangle> triangles;
  bool repaired = false;
};

/// A primitive's faces as single triangles, whatever its mode.
[[nodiscard]] ReadTriangles read_triangles(Reading& reading, const Cursor& primitive,
                                           std::uint32_t vertex_count);

}  // namespace sunder::gltf
