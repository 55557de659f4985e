#pragma once

#include <sunder/operation/operation.h>

#include <optional>

#include "tear/filling/wall_ends.h"
#include "tear/operation/gap_band.h"
#include "tear/operation/outcome.h"
#include "tear/operation/stroke_tip.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

/// A stroke between its first blade and its end: hands each segment to the worker of its kind
/// (nearest_layer.h, all_layers.h, gap_band.h). A plain value, so that a failing call can go back
/// to a copy.
class OngoingStroke {
 public:
  /// Begins another stroke, in the same memory.
  void begin(const Blade& first, const TearOptions& options);

  /// Tears to the next blade, in the pose of `work.posed`.
  void extend(const Blade& to, const Workpiece& work, Outcome& outcome);
  /// To be called before the pose changes: the gap is finished in the pose in which it was swept.
  void leave_pose(const Workpiece& work, Outcome& outcome);
  /// To be called after the pose changed: the blade goes along with the surface on which it stands.
  void enter_pose(const Workpiece& work);
  /// Ends the stroke: finishes the gap and adds the walls.
  void finish(const Workpiece& work, Outcome& outcome);

  [[nodiscard]] const Blade& blade() const { return blade_; }

 private:
  /// Adds walls to lips.
  /// @param front  those near this blade get none yet; null: all get them.
  void add_walls(const Blade* front, const Workpiece& work);

  /// Where the blade stood on the surface in the pose that was left.
  struct Hold {
    Vec3d place = Vec3d::Zero();
    std::optional<SurfaceHit> hit;  ///< And where on it, if that is not the tip.
  };

  TearOptions options_;
  Blade blade_;
  Stroke blades_;  ///< All blades, if there are walls to add.
  LipWalls walls_;
  Blade walls_front_;  ///< The blade when walls were last added.
  StrokeTip tip_;
  GapBand gap_;
  Hold hold_;
};

}  // namespace sunder::tear
