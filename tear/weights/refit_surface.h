#pragma once

#include <vector>

#include "tear/weights/assign_weights.h"
#include "weights/internal/coupled_refit.h"

namespace sunder::tear {

// The surface around the points of a refit.

/// The edges between the points, and from them to vertices of the untorn surface, each once.
/// @param begin  where the first of the operations that created the points began.
[[nodiscard]] std::vector<RefitNeighbours> find_neighbours(const WeightAssignment& assignment,
                                                           const EditLog::Mark& begin,
                                                           const SurfaceEditor& editor);

/// How far the bind position of each point may move, metres in bind space: a third of the smallest
/// height of the faces around it. If no point moves farther, no face is turned over and no point
/// leaves the faces around it.
[[nodiscard]] std::vector<double> find_reach(const WeightAssignment& assignment,
                                             const EditLog::Mark& begin,
                                             const SurfaceEditor& editor);

}  // namespace sunder::tear
