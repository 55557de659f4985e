#pragma once

#include <cstddef>
#include <vector>

#include "support/machine/random.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {

/// A document with several skinned meshes, whose data lies in views of its own, in views that
/// meshes share, interleaved or one after the other; with clips, images, sparse accessors, morph
/// targets, instances by EXT_mesh_gpu_instancing and, by chance, data that nothing uses.
struct RandomDocument {
  GltfBuilder builder;
  std::vector<std::size_t> mesh_nodes;  ///< In the order of the meshes of the loaded character.
  /// Accessors and views to which an unknown extension refers; none without one.
  std::vector<std::size_t> foreign_accessors, foreign_views;
  bool has_vrm = false;  ///< Its extension VRM refers to meshes.
};

RandomDocument random_document(Random& random);

}  // namespace sunder::test
