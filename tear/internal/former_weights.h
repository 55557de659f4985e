#pragma once

#include <sunder/tear/torn_model.h>

#include <span>
#include <vector>

namespace sunder::tear {

/// The weights of a vertex before an operation changed them.
struct FormerWeights {
  Index mesh = 0, vertex = 0;
  Vec3f position = Vec3f::Zero();  ///< Bind position.
  std::span<const Influence> influences;
  /// The vertex was one of WeightPolicy::exact, whose positions per influence are not kept.
  bool was_exact = false;
};

/// The weights that the newest operation changed; none if it is not a WeightsOperation. Ascending
/// by mesh, then by vertex. Valid until the model changes. O(changed vertices). Unpacks the model.
/// @throws std::bad_alloc
[[nodiscard]] SUNDER_API std::vector<FormerWeights> weights_before_newest_operation(
    const TornModel& model);

}  // namespace sunder::tear
