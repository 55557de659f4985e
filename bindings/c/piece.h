#pragma once

#include <sunder/scene/scene_command.h>

#include <memory>

#include "bindings/c/handles.h"
#include "bindings/c/hulls.h"

namespace sunder::c {

struct PieceObject : Object {
  static constexpr Kind kKind = Kind::piece;
  std::shared_ptr<const DetachedPiece> piece;
  std::shared_ptr<const PieceTissue> tissue;  ///< Null if it was not soft.
  HullViews hulls;                            ///< Those of the last call.
};

}  // namespace sunder::c
