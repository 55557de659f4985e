#pragma once

#include <sunder/operation/operation.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tear/geometry/blade_plane.h"
#include "tear/geometry/plane_side.h"
#include "tear/operation/outcome.h"
#include "tear/operation/stroke_tip.h"
#include "tear/posed/workpiece.h"
#include "tear/sheet/gap.h"

namespace sunder::tear {

/// Removes the band of surface that a stroke with a width passes: one convex cell per segment,
/// mitred where two of them meet. It follows one segment behind the stroke, because the mitre
/// depends on where the blade goes next. A plain value, so that a failing call can go back to a
/// copy.
class GapBand {
 public:
  /// One segment of the stroke.
  struct Segment {
    const BladePlane& plane;
    const Blade& from;
    const Blade& to;
  };

  /// Begins another band, in the same memory.
  void begin(double width, Layers layers);
  /// Finds the gap of a segment, and removes that of the previous segment.
  void sweep(const Segment& segment, const Workpiece& work, StrokeTip& tip, Outcome& outcome);
  /// Removes the pending gap up to the end of its segment.
  void catch_up(const Workpiece& work, Outcome& outcome);
  /// The next segment begins in another pose than the last one ended in.
  void enter_pose() { is_in_new_pose_ = true; }

 private:
  /// A segment whose gap is still to be removed. It keeps its memory for later segments.
  struct Pending {
    std::optional<BladePlane> plane;  ///< Of a segment that waits; otherwise none.
    PlaneSide start;
    std::vector<Index> seeds;    ///< Points at which the tear entered the surface.
    std::vector<Index> faces;    ///< Faces that the middle of the gap crosses.
    std::vector<Vec2d> section;  ///< The middle of the gap in the plane, by ascending x.
    double length = 0;

    void begin(const BladePlane& of);
  };
  /// Which side of the gap lies on the plane of a cell's half-space.
  enum class Side : std::uint8_t { none, left, right };

  void find_gap(const Segment& segment, const Workpiece& work, StrokeTip& tip, Pending& gap,
                Outcome& outcome) const;
  [[nodiscard]] double trace_gap(Index start, const Workpiece& work, StrokeTip& tip, Pending& gap,
                                 Outcome& outcome) const;
  void join(const Vec3d& at, const Workpiece& work, Pending& next, Outcome& outcome);
  void close_corner(const Vec3d& at, const Workpiece& work, const Pending& next, Outcome& outcome);
  void remove_pending(const PlaneSide& end, const Workpiece& work, Outcome& outcome);
  [[nodiscard]] PlaneSide start_from_rim(const BladePlane& plane, Index tip,
                                         const Workpiece& work) const;
  [[nodiscard]] ScratchVector<CellFace> faces_to_remove(CellSides& sides, const Pending& gap) const;
  void remove(std::span<const PlaneSide> cell, std::span<const Side> sides, const Pending& gap,
              const Workpiece& work, Outcome& outcome);
  void add_rim_points(const CellRim& rim, std::span<const Side> sides, const BladePlane& plane,
                      Outcome& outcome) const;

  double width_ = 0;
  Layers layers_ = Layers::nearest;
  Pending pending_, next_;
  bool has_removed_ = false;
  bool is_in_new_pose_ = false;
};

}  // namespace sunder::tear
