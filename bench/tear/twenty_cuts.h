#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::bench {

/// The result of twenty cuts with caps across a whole tube of 7,344 faces, in random planes.
struct TwentyCuts {
  std::size_t faces = 0;
  double slowest_seconds = 0;
};
[[nodiscard]] TwentyCuts cut_twenty_times(std::uint32_t seed);

/// The worst of some seeds.
[[nodiscard]] TwentyCuts worst_of_twenty_cuts();

}  // namespace sunder::bench
