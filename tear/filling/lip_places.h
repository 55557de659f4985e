#pragma once

#include "tear/filling/lip_walls.h"
#include "tear/filling/wall_builder.h"

namespace sunder::tear {

/// The end of a half-edge of a rim and the start of the next.
struct LipPlace {
  Index point = kNone;
  Vec3d at = Vec3d::Zero();     ///< Posed.
  Vec3d down = Vec3d::Zero();   ///< Unit direction into the body.
  Vec3d under = Vec3d::Zero();  ///< Unit direction below the opposite lip, or zero.
  double along = 0;             ///< Along the rim from its first place, metres.
  double to_tip = 0;            ///< Along the rim, metres.
  double taper = 1;             ///< 0 at a tip.
  double lean = 1;              ///< Fraction of the lean that leaves the rows in order.
  double room = 1;              ///< Fraction of the depth for which there is room.
  bool is_ready = true;         ///< Whether it may get a wall now.
  bool begins_wall = false;     ///< Whether the edge that begins here gets a wall now.
  Index end = kNone;            ///< Index of the end of an earlier wall that is here.

  [[nodiscard]] bool is_tip() const { return !(taper > 0); }
};

/// The border half-edge between two points, in either direction; kNone if there is none.
[[nodiscard]] Index find_border(const Surface& surface, Index a, Index b);

/// How far the lower edge of a wall lies below the opposite lip, metres.
[[nodiscard]] double lean_of(const LipWallOptions& options);

/// The places of a rim, one more than its half-edges. A closed rim, which ends with its first
/// place, is rotated to begin at its first tip, if it has any; otherwise at a place that is not
/// ready. Directions, lean and room are those of the places that edges with walls need.
[[nodiscard]] ScratchVector<LipPlace> lip_places(Rim& rim, const Stroke& stroke,
                                                 const LipWallOptions& options,
                                                 const LipWalls& walls, WallBuilder& builder);

}  // namespace sunder::tear
