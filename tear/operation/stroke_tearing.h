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

/// A stroke under way: where the tear stands, and what of its gap is left to do. A plain value, so
/// that a failing extension can go back to a copy.
class StrokeTearing {
 public:
  /// Begins another stroke, in the same memory.
  void begin(const Blade& first, const TearOptions& options);

  /// Tears on to the next blade, in the pose that `work.posed` stands for.
  void extend(const Blade& to, const Workpiece& work);
  /// To be called around each change of the pose: the gap is finished in the pose in which it was
  /// swept, and the blade goes along with the surface that it stands on.
  void leave_pose(const Workpiece& work);
  void enter_pose(const Workpiece& work);
  /// Ends the stroke: what of the gap is left to do, and the walls.
  void finish(const Workpiece& work);

  [[nodiscard]] const Blade& blade() const { return blade_; }

  // What was done since they were cleared.
  TearReport report;
  OpenedBorders borders;

 private:
  /// A segment whose part of the gap is still to be removed.
  struct PendingGap {
    BladePlane plane;
    HalfSpace start;
    std::vector<Index> seeds;    ///< Points in which the tear entered the surface.
    std::vector<Index> faces;    ///< That the middle of the gap crosses.
    std::vector<Vec2d> section;  ///< The middle of the gap in the plane, by growing x.
    double length = 0;
  };

  void tear_segment(const BladePlane& plane, const Workpiece& work);
  /// Where the sweep meets the surface next.
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
  /// Does what is left of the gap.
  void catch_up(const Workpiece& work);
  /// Which side of the gap lies on the plane of a cell's half-space.
  enum class Side : std::uint8_t { none, left, right };
  void remove(const Cell& cell, std::span<const Side> sides, const PendingGap& gap,
              const Workpiece& work);
  void add_rim_points(const CellRim& rim, std::span<const Side> sides, const BladePlane& plane);
  [[nodiscard]] bool stands_on_surface(const Workpiece& work) const;

  TearOptions options_;
  Blade blade_, blade_before_;
  Stroke stroke_;                  ///< All blades, for the walls.
  Index tip_ = kNone;              ///< Where the tear stands, while it stands on the surface.
  bool tip_ends_run_ = false;      ///< Not where a first segment was too short to tear.
  std::optional<SurfaceHit> met_;  ///< Where the blade meets the surface at the beginning of the
                                   ///< segment, until that is used.
  Index last_end_ = kNone;         ///< Where the last piece of the segment under way ended.
  std::size_t torn_edges_ = 0;
  std::optional<PendingGap> pending_;
  Vec3d held_before_ =
      Vec3d::Zero();  ///< Where the blade stood on the surface in the pose that was left.
  std::optional<SurfaceHit> held_by_;  ///< And where on it, where that is not the tip.
  bool has_removed_ = false;
  bool is_in_new_pose_ = false;
};

}  // namespace sunder::tear
