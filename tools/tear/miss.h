#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <optional>
#include <string>

#include "tools/model/posed_model.h"
#include "tools/model/posed_source.h"
#include "tools/tear/report.h"

namespace sunder::tools {

/// How an operation passed the surface by.
struct Miss {
  /// Between the posed surface and the sweep of the blade, the plane within its bounds, or the axis
  /// of the bore; metres.
  double distance = 0.0;
  /// Where the blade, the bounds or the axis came nearest, and the way from there to the surface:
  /// moved by it, they would touch. Empty for a whole plane, and where something was met.
  std::optional<Vec3d> place = {};
  Vec3d way = Vec3d::Zero();
  /// Of a tear: the blade that ends the nearest segment of its stroke.
  std::uint32_t blade = 0;
  Bounds bounds;      ///< Of the posed surface.
  std::string cause;  ///< What would meet the surface; empty if there is no evidence.
};

/// Measures a miss.
/// @param operation  a tear, cut or bore that met no surface of the model.
/// @param source     of the model; posed instead of the torn model while nothing was retired.
[[nodiscard]] Result<Miss> measure_miss(const Operation& operation, const TornModel& model,
                                        PosedSource& source);

/// Looks for the cause of a miss: another unit, another pose, blades that point away or end too
/// early, or a stroke that is too small for its face. A cause is stated only if the operation,
/// corrected, meets the source. O(faces) per attempt; at most about forty.
[[nodiscard]] Result<std::string> cause_of_miss(const Operation& operation, const Miss& miss,
                                                const TornModel& model,
                                                const std::shared_ptr<const Character>& source);

/// "the blade passes 8.3 m from the surface, which spans … in this pose; …".
[[nodiscard]] std::string miss_text(const Operation& operation, const Miss& miss);
[[nodiscard]] Json to_json(const Miss& miss);

}  // namespace sunder::tools
