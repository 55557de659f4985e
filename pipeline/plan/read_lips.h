#pragma once

#include <sunder/plan/plan.h>

#include <optional>
#include <vector>

namespace sunder::plan {

/// A run of places along the lips of a torn character.
struct LipCurve {
  std::uint32_t mesh = 0;
  std::vector<std::uint32_t> vertices;  ///< One of each place, in order.
  bool is_closed = false;               ///< The last place is joined with the first one.
};

/// The longest run of edges that are open and lie on one another: two lips of a tear without width
/// in bind space. A wound that branches gives its longest way. @return empty if there is none.
[[nodiscard]] std::optional<LipCurve> read_lips(const Character& torn);

}  // namespace sunder::plan
