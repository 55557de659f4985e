#pragma once

#include <span>
#include <vector>

#include "pipeline/binding/attach.h"
#include "pipeline/binding/bone_segments.h"
#include "pipeline/binding/welded_surface.h"

namespace sunder::binding {

/// Weights of points at the end of the heat's flow, and the counts of HeatBinding.
struct HeatWeights {
  std::vector<WeightRow> rows;  ///< Per point; not empty, >= 0, sum to one.
  std::uint32_t heated_points = 0, parts_without_sight = 0, lone_points = 0;
  std::uint32_t edges = 0, clamped_edges = 0;
};

/// Solves (L + H) w = H p per bone, one factorisation for all: L is the stiffness of the surface;
/// H = mass * heat * k / d^2 at points that see their nearest bone at distance d, of which k are
/// equally near, else 0; p is 1/k for each of these.
/// @param segments  not empty.
/// @return internal_error if the factorisation fails.
[[nodiscard]] Result<HeatWeights> heat_weights(const WeldedSurface& surface,
                                               std::span<const BoneSegment> segments, double heat);

}  // namespace sunder::binding
