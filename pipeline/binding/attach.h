#pragma once

#include <vector>

#include "pipeline/binding/joined.h"

namespace sunder::binding {

/// A bone's share in a vertex; bones are the rig's.
struct BoneWeight {
  Index bone = 0;
  double weight = 0;
};

/// The weights of a vertex, each bone once. Not empty, positive, of any sum.
using WeightRow = std::vector<BoneWeight>;

/// Writes the meshes of a model with new weights onto the rig's skeleton. Meshes that shared a skin
/// share one.
/// @param rows   per mesh and vertex.
/// @param joins  whether meshes of different skins share one too, if both carry them by the same
///               matrix.
/// @return invalid_argument for a bone with weight whose pose has no inverse.
[[nodiscard]] Result<Binding> attach(const Joined& joined,
                                     const std::vector<std::vector<WeightRow>>& rows, bool joins);

}  // namespace sunder::binding
