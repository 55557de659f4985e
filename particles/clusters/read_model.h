#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Reads the skins, points, vertices and posed positions of a model into an empty structure.
/// O(vertices + triangles), allocates.
/// @param pose  of the decomposition; of the character, finite.
void read_model(const TornModel& model, const ModelPose& pose, Structure& structure);

/// Diagonal of the box around the points with a face, metres; 0 where there is none.
[[nodiscard]] double diagonal_of(const Structure& structure, const TornModel& model);

}  // namespace sunder::particles
