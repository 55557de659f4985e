#pragma once

#include <span>
#include <vector>

#include "particles/clusters/structure.h"
#include "particles/internal/bits.h"

namespace sunder::particles {

/// Lists the members of particles in ascending order. A bit per point orders them, because lists of
/// thousands of points take longer to sort than to sum up.
class MemberSearch {
 public:
  /// @param structure  must outlive this, and keep its points.
  explicit MemberSearch(const Structure& structure) : structure_(structure) {
    is_candidate_.resize(structure.points.count());
  }

  /// Points of a particle. Valid until the next call. O(members + points / 64).
  [[nodiscard]] std::span<const Index> members_of(Index particle);

 private:
  const Structure& structure_;
  Bits is_candidate_;  ///< All zero between calls.
  std::vector<Index> found_;
};

}  // namespace sunder::particles
