#pragma once

#include <sunder/core/mesh.h>

#include <string>
#include <vector>

#include "io/gltf_read/reading.h"

namespace sunder::gltf {

/// Primitives of one glTF mesh that use the same vertices; they become the submeshes of one mesh.
struct PrimitiveGroup {
  std::vector<std::uint32_t> primitives;  ///< Indices in the mesh's primitives.
};

/// Groups a mesh's primitives by their vertices. Primitives without triangles or positions are
/// dropped, with a note.
[[nodiscard]] std::vector<PrimitiveGroup> group_primitives(Reading& reading, const Cursor& mesh);

struct ReadTriangles {
  std::vector<Triangle> triangles;
  bool repaired = false;
};

/// A primitive's faces as separate triangles, for any mode.
[[nodiscard]] ReadTriangles read_triangles(Reading& reading, const Cursor& primitive,
                                           std::uint32_t vertex_count);

}  // namespace sunder::gltf
