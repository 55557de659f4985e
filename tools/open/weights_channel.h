#pragma once

#include <sunder/core/clip.h>

#include <optional>
#include <span>
#include <vector>

#include "tools/open/opening.h"

namespace sunder::tools {

/// The weight of an appended morph target during a clip: lines between keys, constant before the
/// first and after the last. Times in seconds of the clip, ascending.
struct WeightKey {
  double time = 0, weight = 0;

  bool operator==(const WeightKey&) const = default;
};

/// The course of an opening in a clip: 0 until `moment`, then as the opening, faster if the clip
/// ends before. Always 1 in a clip without duration.
/// @param end  the lips open evenly until then, not as the tissue does.
[[nodiscard]] std::vector<WeightKey> keys_of(const Opening& opening, double moment, double duration,
                                             std::optional<double> end = std::nullopt);

/// The channel of all weights of a mesh, with one more at its end.
/// @param old   drives consecutive weights of the mesh; null: none does.
/// @param rest  the mesh's weights where nothing drives them.
/// @param keys  of the last weight; at least one.
/// @param first  index of the first weight for the new channel.
/// All values between the old keys stay as they were, up to rounding; of a stepped channel the last
/// weight is stepped too.
[[nodiscard]] Channel with_weight(const Channel* old, std::span<const float> rest,
                                  std::uint32_t old_first, std::span<const WeightKey> keys,
                                  std::uint32_t first);

}  // namespace sunder::tools
