#pragma once

#include <sunder/operation/operation.h>

#include <optional>
#include <span>

#include "tear/geometry/plane_side.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The limits of a cut to some of its sections. A section is a connected run of faces that the
/// sheet meets: two faces are connected if its plane crosses their common edge within the bounds.
struct SectionLimits {
  /// The section nearest to each place is chosen; of sections at the same distance, within
  /// rounding, all are.
  std::span<const Vec3d> places = {};
  std::optional<SectionRay> first_hit = {};  ///< The section that it meets first is chosen.
  /// If not empty, per bone: sections that these bones move by half or less do not count.
  ScratchVector<bool> is_wanted_bone;

  [[nodiscard]] bool has_any() const {
    return !places.empty() || first_hit || !is_wanted_bone.empty();
  }
};

/// @param faces   of faces_across(), ascending.
/// @return the faces of the sections that the limits choose, ascending. O(faces x (log faces +
///         places + bounds + influences)).
[[nodiscard]] ScratchVector<Index> faces_of_sections(const Sheet& sheet,
                                                     const SectionLimits& limits,
                                                     ScratchVector<Index> faces,
                                                     const SurfaceEditor& editor,
                                                     PosedPoints& posed);

}  // namespace sunder::tear
