#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/model/posed_source.h"
#include "tools/model/posed_surface.h"
#include "tools/tear/torn_place.h"

namespace sunder::tools {

/// Faults of an operation that is valid: a time beyond its clip.
[[nodiscard]] std::vector<std::string> time_warnings(const Operation& operation,
                                                     const Character& character);

/// Faults of a tear that met the surface: base and tip swapped, a gap wider than the body.
/// Base and tip count as swapped if the torn faces point along the blade and most bases lie inside
/// the surface and most tips outside. O(1), or O(faces) if the faces do, or with a width.
/// @param pose  of the tear's first blade.
[[nodiscard]] Result<std::vector<std::string>> stroke_warnings(const TearOperation& tear,
                                                               const ModelPose& pose,
                                                               const TornPlace& place,
                                                               PosedSource& source);

/// The width of the body where a stroke enters it: across the sweep, through the place halfway
/// between where the blade in the middle of the stroke enters the surface and where it leaves it,
/// or the nearest other blade that does both. Empty if none does, or if the surface is open there.
[[nodiscard]] std::optional<double> body_width(const PosedSurface& surface, const Stroke& stroke);

}  // namespace sunder::tools
