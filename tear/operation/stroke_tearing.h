#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/report.h>

#include <optional>
#include <span>
#include <vector>

#include "tear/geometry/blade_plane.h"
#include "tear/geometry/half_space.h"
#include "tear/path/entry.h"
#include "tear/posed/workpiece.h"
#include "tear/sheet/gap.h"
#include "tear/surface/opened_borders.h"

namespace sunder::tear {

/// The state of a stroke under way: the tip of the tear, and the part of its gap that is still to
/// be removed. A value type, so that a failed extension can be restored from a copy.
class StrokeTearing {
 public:
  /// Begins another stroke. The memory is reused.
  void begin(const Blade& first, const TearOptions& options);

  /// Continues the tear to the next blade, in the pose of `work.posed`.
  void extend(const Blade& to, const Workpiece& work);
  /// To be called before and after each change of the pose. The gap is finished in the pose in
  /// which it was swept, and the blade moves with the surface that it stands on.
  void leave_pose(const Workpiece& work);
  void enter_pose(const Workpiece& work);
  /// Ends the stroke: removes the rest of the gap and adds the walls.
  void finish(const Workpiece& work);

  [[nodiscard]] const Blade& blade() const { return blade_; }

  // Changes since these were last cleared.
  TearReport report;
  OpenedBorders borders;

 private:
  /// A segment whose part of the gap is still to be removed.
  struct PendingGap {
    BladePlane plane;
    HalfSpace start;
    std::vector<Index> seeds;    ///< Points at which the tear entered the surface.
    std::vector<Index> faces;    ///< Faces that the middle of the gap crosses.
    std::vector<Vec2d> section;  ///< The middle of the gap in the plane, ascending by x.
    double length = 0;
  };

  void tear_segment(const BladePlane& plane, const Workpiece& work);
  /// The next place where the sweep meets the surface.
  [[nodiscard]] std::optional<SurfaceHit> find_contact(const BladePlane& plane, double progress,
                                                       const Workpiece& work);
  double tear_piece(const BladePlane& plane, Index start, const EditLog::Mark& before,
                    const Workpiece& work);
  void tear_all_layers(const BladePlane& plane, const Workpiece& work);

  void sweep_gap(const BladePlane& plane, const Workpiece& work);
  [[nodiscard]] PendingGap find_gap(const BladePlane& plane, const Workpiece& work);
  void join_gaps(PendingGap& next, const Vec3d& at, const Workpiece& work);
  void remove_pending(const HalfSpace& end, const Workpiece& work);
  [[nodiscard]] HalfSpace start_from_rim(const BladePlane& plane, Index tip,
                                         const Workpiece& work) const;
  /// Removes the rest of the gap.
  void catch_up(const Workpiece& work);
  /// The side of the gap that lies on the plane of a half-space of a cell.
  enum class Side : std::uint8_t { none, left, right };
  void remove(const Cell& cell, std::span<const Side> sides, const PendingGap& gap,
              const Workpiece& work);
  void add_rim_points(const CellRim& rim, std::span<const Side> sides, const BladePlane& plane);
  [[nodiscard]] bool stands_on_surface(const Workpiece& work) const;

  TearOptions options_;
  Blade blade_, blade_before_;
  Stroke stroke_;      ///< All blades, for the walls.
  Index tip_ = kNone;  ///< The tip of the tear; kNone if it is not on the surface.
  /// Whether a torn run ends at the tip; false if the first segment was too short to tear.
  bool tip_ends_run_ = false;
  /// The place where the blade meets the surface at the start of the segment, until it is used.
  std::optional<SurfaceHit> met_;
  Index last_end_ = kNone;  ///< The end point of the last piece of the current segment.
  std::size_t torn_edges_ = 0;
  std::optional<PendingGap> pending_;
  /// The place of the blade on the surface in the pose that was left.
  Vec3d held_before_ = Vec3d::Zero();
  /// That place as a hit on the surface, if it is not the tip.
  std::optional<SurfaceHit> held_by_;
  bool has_removed_ = false;
  bool is_in_new_pose_ = false;
};

}  // namespace sunder::tear
