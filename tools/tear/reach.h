#pragma once

#include <sunder/operation/operation.h>

#include <optional>
#include <vector>

#include "tools/model/posed_surface.h"

namespace sunder::tools {

/// The space that one operation passes through in one pose: the sweep of a blade, the bounds of a
/// plane, or the axis of a bore. Model space.
struct Reach {
  PoseSpec pose;
  std::vector<Corners> shape;     ///< Triangles; empty for a whole plane.
  std::optional<PlaneCut> plane;  ///< A whole plane.
  double radius = 0.0;            ///< Of a bore.
  std::uint32_t first_blade = 0;  ///< Of a tear: the one that ends the first two triangles.
};

/// One entry per pose of the operation; empty if it passes through nothing, like `undo`.
[[nodiscard]] std::vector<Reach> reaches_of(const Operation& operation);

/// The least distance between a surface and what an operation passes through. The search ends at a
/// distance of at most `enough`.
[[nodiscard]] double distance_between(const PosedSurface& surface, const Reach& reach,
                                      double enough = 0.0);
[[nodiscard]] bool meets(const PosedSurface& surface, const Reach& reach);

/// The bounds of a shape, or of the point of a whole plane.
[[nodiscard]] Bounds bounds_of(const Reach& reach);

/// The operation with all lengths and places multiplied.
[[nodiscard]] Operation scaled(const Operation& operation, double factor);

/// A stroke that is longer by a factor, about the middle of its blades, which stay as deep. Other
/// operations stay as they are.
[[nodiscard]] Operation enlarged(const Operation& operation, double factor);

/// The operation in another pose throughout.
[[nodiscard]] Operation in_pose(const Operation& operation, const PoseSpec& pose);

/// With its blades or its axis, as long as before, on the other side of their bases.
[[nodiscard]] Operation turned_round(const Operation& operation);

/// With blades or an axis of another length.
[[nodiscard]] Operation lengthened(const Operation& operation, double length);

}  // namespace sunder::tools
