#pragma once

#include "particles/clusters/structure.h"

namespace sunder::particles {

/// Reads the skins, points, vertices and posed positions of a model into an empty structure.
/// O(vertices + triangles), allocates.
/// @param pose  of the decomposition; it fits the character and is finite.
void read_model(const TornModel& model, const ModelPose& pose, Structure& structure);

/// Diagonal of the box around the points that have a face, metres; 0 if there are none.
[[nodiscard]] double diagonal_of(const Structure& structure, const TornModel& model);

}  // namespace sunder::particles
