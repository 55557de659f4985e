#pragma once

#include <sunder/scene/scene_command.h>

#include <memory>
#include <vector>

#include "bindings/c/handles.h"

namespace sunder::c {

struct PieceObject : Object {
  static constexpr Kind kKind = Kind::piece;
  std::shared_ptr<const DetachedPiece> piece;
  std::shared_ptr<const PieceTissue> tissue;  ///< Null if it was not soft.
  std::vector<ConvexHull> hulls;              ///< Those of the last call.
  std::vector<sunder_hull> hull_views;
};

}  // namespace sunder::c
