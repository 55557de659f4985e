#pragma once

#include <sunder/skinning/skinned_mesh.h>

#include "scene/drawing/draw_order.h"

namespace sunder::scene {

/// One mesh of an asset.
struct AssetMesh {
  SkinnedMesh skinned;
  std::size_t slots = 0;  ///< Of its skin.
  DrawOrder order;
  bool poses_vertices = true, has_normals = false, has_tangents = false;
};

}  // namespace sunder::scene
