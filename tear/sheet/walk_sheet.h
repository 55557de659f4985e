#pragma once

#include <span>

#include "tear/geometry/plane_side.h"
#include "tear/posed/posed_points.h"
#include "tear/surface/line_splitter.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// Imprints an unbounded sheet by walking along it, from face to face. Each face that it crosses
/// away from the corners is split in three at once. What is not as simple is left over: lines along
/// edges, and faces that are too small to be split.
class SheetWalk {
 public:
  SheetWalk(const PlaneSide& plane, SurfaceEditor& editor, PosedPoints& posed);

  /// Begins a stage when the edges in the way of the plane are turned.
  /// @param faces  of faces_across().
  void cross(std::span<const Index> faces);

  /// Directed so that the inside of the plane is on the left, run after run.
  [[nodiscard]] const ScratchVector<PointEdge>& edges() const { return edges_; }
  /// Per edge, its half-edge where it is known.
  [[nodiscard]] const ScratchVector<Index>& half_edges() const { return half_edges_; }
  [[nodiscard]] Index run_count() const { return runs_; }
  /// Whether each run is closed or goes from border to border.
  [[nodiscard]] bool are_runs_whole() const { return are_whole_; }
  [[nodiscard]] Index faces_crossed() const { return faces_crossed_; }
  /// The faces, as they were before, that have yet to be crossed, in part or as a whole.
  [[nodiscard]] const ScratchVector<Index>& left_over() const { return left_over_; }

 private:
  enum class At : std::uint8_t { inside, begin, end };  ///< Of a half-edge.
  /// Where the plane crosses a half-edge.
  struct Crossing {
    At at;
    double fraction;
    Vec3d position;
  };
  /// The corner of a face that is alone on its side; kNone if the face is not across.
  [[nodiscard]] Index lone_corner(Index face);
  [[nodiscard]] bool is_inside(Index point) { return posed_.is_inside(editor_, point); }
  [[nodiscard]] Crossing crossing(Index half_edge);
  /// Whether the plane passes at least two corners of a face.
  [[nodiscard]] bool has_edge_on_plane(Index face);
  [[nodiscard]] bool is_among_source_faces(Index face) const;
  /// Flips edges out of the way of the plane, from a face that it crosses. Faces that this makes
  /// are appended to `faces_`.
  void turn_edges_at(Index face);
  bool turn_edge(Index half_edge);
  /// Whether turning an edge would leave a face so thin that stored positions cannot tell it from a
  /// line, in place of wider ones.
  [[nodiscard]] bool makes_needle(Index half_edge) const;
  bool turn_cap_edge(Index half_edge, double least_shape_factor);
  /// Flips the longest edge of a face of a cap that is nearly a line.
  void turn_needle(Index face);
  void walk_from(Index face);
  /// Crosses faces from the splitter's newest point on. @return whether it came back to `start`.
  bool go(LineSplitter& splitter, Index start);
  bool go_back(Index half_edge, const Crossing& at, Index start);
  void add(Index from, Index to, Index half_edge);
  /// Ends a run, whose forward part ends at `middle`.
  void end_run(std::size_t first, std::size_t middle, bool is_inside_left);

  PlaneSide plane_;
  SurfaceEditor& editor_;
  PosedPoints& posed_;
  Index first_new_point_;
  Index newest_ = kNone;        ///< Point.
  ScratchVector<Index> faces_;  ///< To be crossed; some of them may be retired.
  ScratchVector<PointEdge> edges_;
  ScratchVector<Index> half_edges_, left_over_;
  Index runs_ = 0, faces_crossed_ = 0;
  bool are_whole_ = true;
};

}  // namespace sunder::tear
