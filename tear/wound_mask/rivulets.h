#pragma once

#include <sunder/tear/wound_mask.h>

#include <functional>
#include <span>
#include <vector>

#include "tear/wound_mask/spread.h"

namespace sunder::tear {

/// A straight part of a rivulet in a face of the source.
struct RivuletPart {
  Index face = 0;
  LipSegment segment;
  double radius = 0;  ///< Metres in bind space.
};

/// Follows blood down a surface in a pose.
class Rivulets {
 public:
  using IsRemoved = std::function<bool(Index face, const std::array<double, 3>& place)>;

  /// @param posed    per mesh of the source, the positions of its vertices.
  /// @param options  are valid.
  Rivulets(const Character& source, const FlatFaces& faces,
           std::span<const std::vector<Vec3f>> posed, const BloodFlowOptions& options,
           IsRemoved is_removed);

  /// Adds the rivulets from the lips of a face. Both depend on the lips of this face alone.
  void run_from(Index face, std::span<const LipSegment> lips);
  [[nodiscard]] std::span<const RivuletPart> parts() const { return parts_; }

 private:
  using Place = std::array<double, 3>;

  /// A rivulet on its way.
  struct Run {
    Index face = 0;
    Place at = {};
    double gone = 0, length = 0, radius = 0;  ///< Metres.
    double phase = 0;                         ///< Of its wandering, radians.
  };
  /// The steepest way down in a face, as a change of barycentric coordinates per metre in bind
  /// space. @return false: it is too flat
  [[nodiscard]] bool descend(const Run& run, Place& rate) const;
  [[nodiscard]] Vec3d corner(Index half_edge) const;
  void follow(Run run);
  /// Goes on in the next face, or along the edge or from the corner that is the way down.
  [[nodiscard]] bool cross(Run& run, Index half_edge);
  [[nodiscard]] bool leave_corner(Run& run, Index corner);
  /// The way down from a corner: into its face, or along the half-edge that leaves it.
  struct WayDown {
    Index half_edge = kNone;  ///< kNone: there is none.
    bool is_inside = false;
  };
  [[nodiscard]] WayDown way_from(const Run& run, Index corner) const;
  /// Goes straight to a place of the same face. @return false: the rivulet ends
  [[nodiscard]] bool go_to(Run& run, const Place& place);

  const Character& source_;
  const FlatFaces& faces_;
  std::span<const std::vector<Vec3f>> posed_;
  BloodFlowOptions options_;
  IsRemoved is_removed_;
  std::vector<RivuletPart> parts_;
};

}  // namespace sunder::tear
