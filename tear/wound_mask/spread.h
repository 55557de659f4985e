#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "tear/wound_mask/beam.h"

namespace sunder::tear {

/// A lip inside a triangle of the source: barycentric coordinates of its ends.
struct LipSegment {
  std::array<std::array<double, 3>, 2> ends = {};

  bool operator==(const LipSegment&) const = default;
  auto operator<=>(const LipSegment&) const = default;
};

/// A beam and the face in whose plane it lies.
struct SpreadBeam {
  Index face = 0;
  Beam beam;
};

/// Follows beams from the lips of a triangle over the faces of a source. What it finds depends on
/// these lips alone, so that others may come and go. Memory is reused.
class Spread {
 public:
  /// @param faces  must outlive it. @param reach  the length of the longest path, metres.
  Spread(const FlatFaces& faces, double reach)
      : faces_(faces), reach_(reach), nearest_(faces.surface.point_count(), Beam::kNotSeen) {}

  /// All beams of the lips of a face. Valid until the next call. O(beams).
  std::span<const SpreadBeam> from(Index face, std::span<const LipSegment> lips);

 private:
  /// A beam that has entered a face.
  struct Entered {
    Beam beam;
    Index half_edge = 0;  ///< Across which it came, in the face that it entered.
  };
  /// A corner around which paths bend.
  struct Bend {
    Index corner = 0;
    Flat back;  ///< Direction in which the path came.
    double distance = 0;
  };

  /// Where a beam crosses an edge: shares of its length from its half-edge of the lower index, and
  /// the distances from the lip there.
  struct Crossing {
    double begin = 0, end = 0;
    double least = 0, most = 0;
  };

  void start_segment(Index face, const LipSegment& lip);
  void start_point(Index face, const std::array<double, 3>& place);
  void shine_from_point(Index face, Flat place, double offset);
  void finish();
  void enter(Index half_edge, const Beam& beam);
  void pass(const Entered& entered);
  void pass_strip(const Entered& entered);
  void pass_fan(const Entered& entered);
  /// Sends the part of a beam between two limits across an edge.
  void send_strip(Index half_edge, Beam beam, double low, double high);
  void send_fan(Index half_edge, Beam beam, Flat left, Flat right);
  /// Whether another beam crosses the same part of the edge on shorter paths. Without it, beams
  /// would wind around a needle, whose girth is nothing, until memory ends.
  [[nodiscard]] bool is_covered(Index half_edge, Crossing crossing);
  void see_corner(Index corner, const Beam& beam);
  void bend(const Bend& around);

  const FlatFaces& faces_;
  double reach_;
  std::vector<double> nearest_;  ///< Per point: the shortest path that bends there.
  std::vector<Index> met_;       ///< Points with a known path.
  std::unordered_map<Index, Crossing> crossings_;  ///< Per edge: the widest one.
  std::vector<Entered> entered_;
  std::vector<Bend> bends_;
  std::vector<SpreadBeam> beams_;
};

}  // namespace sunder::tear
