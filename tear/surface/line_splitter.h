#pragma once

#include <optional>

#include "tear/internal/mesh_vertices.h"
#include "tear/surface/face_split.h"

namespace sunder::tear {

/// How the position of a new point is stored.
enum class Rounding : std::uint8_t {
  nearest,
  as_fits,  ///< One unit in the last place aside where the faces would turn over otherwise.
};

/// Splits faces one after the other along a line across the surface, with a new point wherever it
/// meets an edge. Between begin() and end() the face ahead is still whole and not joined to the
/// faces behind it, so nothing else may change the surface.
class LineSplitter {
 public:
  explicit LineSplitter(SurfaceEditor& editor) : editor_(editor) {}

  /// Puts a point on an edge, `fraction` of the way along the half-edge, and splits the half-edge's
  /// face in two.
  /// @return the point; kNone if that face or the one ahead would lose its area or turn over, and
  /// nothing was changed.
  [[nodiscard]] Index begin(Index half_edge, double fraction,
                            Rounding rounding = Rounding::nearest);
  /// Puts a point on another edge of the face ahead, and splits that face in three, along the
  /// diagonal that makes the better faces. @return as begin().
  [[nodiscard]] Index go_on(Index half_edge, double fraction);
  /// Splits the face ahead in two. Must be called last.
  void end();

  /// The half-edge by which the face ahead is entered; kNone at a border.
  [[nodiscard]] Index ahead() const { return points_[newest_].ahead; }
  /// The half-edge to the newest point from the one before it, or from the corner opposite the
  /// first edge.
  [[nodiscard]] Index half_edge() const { return half_edge_; }

 private:
  /// An edge with a point on it, in one face: its half-edges to the point and from it.
  struct EdgeParts {
    Index to_point = kNone, from_point = kNone;
  };
  /// A point on an edge, with its role in the faces on both sides.
  struct NewPoint {
    Index mesh = 0;
    FaceSplit::Corner of_behind, of_ahead;
    Index ahead = kNone;  ///< Half-edge of the face ahead; kNone at a border.
    std::optional<FaceSplit> face_ahead;
    bool is_sound = true;  ///< Whether the face ahead can be split in two there.
    Index point = kNone;

    [[nodiscard]] bool is_two_vertices() const {
      return face_ahead && (of_ahead.vertex != of_behind.vertex || face_ahead->mesh() != mesh);
    }
  };

  struct Part;
  struct PartCorner {
    Index point, vertex;
  };
  /// A face (u, v, w) that the line enters through p on u -> v and leaves through q.
  struct CrossedFace {
    Index uv;
    PartCorner u, v, w, p, q;
  };
  struct ThreeParts {
    EdgeParts entry, exit;
    Index along;  ///< The half-edge from p to q.
  };

  /// Makes room for a point and its vertices, for `triangles`, and for those that end() makes.
  void make_room(const FaceSplit& behind, Index half_edge, Index triangles);
  void append_vertices(const FaceSplit& behind, Index half_edge, double fraction, NewPoint& made);
  /// Whether the faces on both sides of a half-edge can be split at a point.
  [[nodiscard]] static bool is_sound(const FaceSplit& behind, Index half_edge,
                                     const NewPoint& made);
  /// Moves a point aside by one unit in the last place of a coordinate or several, so that the
  /// faces keep their winding. @return false if no such place does.
  bool round_aside(const FaceSplit& behind, Index half_edge, NewPoint& made);
  void remove_vertices(const NewPoint& made);
  void append_point(NewPoint& made);
  /// Appends a triangle that is split from another one. @return its first half-edge.
  [[nodiscard]] Index append_part(Index of, const PartCorner& a, const PartCorner& b,
                                  const PartCorner& c);
  EdgeParts split_in_two(Index half_edge, Index point, Index vertex);
  void split_in_three(Index half_edge, const NewPoint& to, bool cuts_from_q);
  /// The third edge keeps its half-edge, so the face across it does not change.
  [[nodiscard]] ThreeParts cut_off_v(const CrossedFace& face, bool cuts_from_q);
  [[nodiscard]] ThreeParts cut_off_u(const CrossedFace& face, bool cuts_from_q);
  void join_behind(const EdgeParts& ahead);

  SurfaceEditor& editor_;
  std::array<NewPoint, 2>
      points_;  ///< The newest point, and the one before it or that is being made.
  std::size_t newest_ = 0;
  EdgeParts behind_;  ///< The parts of the edge with the newest point.
  Index half_edge_ = kNone;
};

}  // namespace sunder::tear
