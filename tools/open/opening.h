#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>
#include <sunder/particles/authored_tissue.h>
#include <sunder/skinning/deform.h>

#include <memory>
#include <span>
#include <vector>

#include "tools/open/wound_walls.h"

namespace sunder::tools {

/// How the lips of a torn model come to gape, in the pose of its last operation that tears.
struct Opening {
  /// A moment while they open.
  struct Moment {
    double seconds = 0;  ///< Since the tear.
    double share = 0;    ///< Of the whole opening: 0 at first, 1 at last.
  };
  ModelPose pose;
  std::vector<DeformedMesh> closed, open;  ///< Per mesh, model space; open: at rest again.
  std::vector<Moment> course;              ///< Few, for linear interpolation.
  std::vector<double> gaps;                ///< Of each wound: between points that were one, metres.
  double widest_gap = 0;                   ///< The greatest of them.
  WoundWalls walls;                        ///< Between the lips.
  WoundWalls threads;                      ///< Across them, of sutures.
};

/// Tears a character of soft tissue, and lets its lips open until nothing moves.
/// @param history   operations that are valid for the character; at least one.
/// @param authored  the fields of the tissue; empty: uniform.
/// @return the first failure of an operation. Without lips, nothing is open.
[[nodiscard]] Result<Opening> measure_opening(std::shared_ptr<const Character> character,
                                              std::span<const Operation> history,
                                              const AuthoredTissue& authored);

}  // namespace sunder::tools
