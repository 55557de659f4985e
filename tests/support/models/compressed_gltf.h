#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "support/models/gltf_builder.h"

namespace sunder::test {

/// The GLB that save_glb() writes for a character without a source, to be changed further.
GltfBuilder built_from(const Character& character);

struct MeshoptPacking {
  std::string extension = "EXT_meshopt_compression";
  bool as_sequences = false;  ///< Indices in the mode INDICES, not TRIANGLES.
};

/// The same document with its vertex data, keys and indices compressed by meshoptimizer, without
/// loss. The views lie in a fallback buffer without data.
GltfBuilder packed_by_meshopt(const GltfBuilder& source, const MeshoptPacking& packing = {});

struct DracoPacking {
  bool is_sequential = false;  ///< Keeps the order of the vertices; else by edgebreaker.
  int bits = 0;                ///< Of floats; 0: without loss.
};

/// The same document with its primitives compressed by Draco, except for morph targets. Its
/// accessors have no buffer view, and unique ids of attributes are not their indices.
GltfBuilder packed_by_draco(const GltfBuilder& source, const DracoPacking& packing = {});

}  // namespace sunder::test
