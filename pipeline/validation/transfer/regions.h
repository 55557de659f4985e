#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "pipeline/validation/match/surface_match.h"

namespace sunder::validation {

/// The plane in which left and right bones mirror each other.
struct SidePlane {
  Vec3d point = Vec3d::Zero();
  Vec3d normal = Vec3d::Zero();  ///< Unit, towards the right.

  /// -1 left, +1 right; 0 within `band` of the plane.
  [[nodiscard]] int side_of(const Vec3d& position, double band) const;
};

/// The plane between the bones at bind whose names differ in their side alone. nullopt without such
/// bones.
[[nodiscard]] std::optional<SidePlane> find_side_plane(const Character& character);

/// The places of a source where the vertices of a target may be matched.
struct MatchRegions {
  std::vector<Index> source_part;  ///< Per triangle of the source; empty: one part.
  std::vector<Index> target_part;  ///< Per vertex of the target; empty: one part.
  std::vector<int> source_side;    ///< Per triangle: where its bones belong; empty: no sides.
  std::vector<int> target_side;    ///< Per vertex.
};

/// As match_surfaces(), but a vertex on the left is not matched to a triangle of the right. Each
/// part of the target is matched to that part of the source at which most of its vertices are.
[[nodiscard]] SurfaceMatches match_in_regions(const BindSurface& target, const BindSurface& source,
                                              const MatchLimits& limits,
                                              const MatchRegions& regions);

}  // namespace sunder::validation
