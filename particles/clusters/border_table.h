#pragma once

#include <sunder/core/index.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "core/internal/ordered.h"

namespace sunder::particles {

/// Sums parts of borders per pair of cells. A hash table with linear probing.
class BorderTable {
 public:
  struct Entry {
    std::uint64_t pair =
        kNoPair;  ///< The lower particle in the high bits, the higher one in the low bits.
    int edges = 0;
    Vec3d across = Vec3d::Zero();  ///< Towards the higher particle.
    Vec3d middles = Vec3d::Zero();

    [[nodiscard]] Index low() const { return static_cast<Index>(pair >> 32u); }
    [[nodiscard]] Index high() const { return static_cast<Index>(pair); }
  };

  /// @param pairs  expected; there may be more.
  explicit BorderTable(std::size_t pairs) : entries_(std::bit_ceil(2 * pairs + 16)) {}

  /// Adds a part of a border, or removes it.
  /// @param sign  1 or -1.
  /// @param across  towards q.
  void add(Index p, Index q, int sign, const Vec3d& across, const Vec3d& middle) {
    const bool is_ascending = p < q;
    Entry& entry =
        entry_of(is_ascending ? std::uint64_t{p} << 32u | q : std::uint64_t{q} << 32u | p);
    entry.edges += sign;
    entry.across += (is_ascending ? sign : -sign) * across;
    entry.middles += sign * middle;
  }

  /// Calls visit(entry) for all pairs, in an order without a meaning.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const Entry& entry : entries_)
      if (entry.pair != kNoPair) visit(entry);
  }

 private:
  static constexpr std::uint64_t kNoPair = ~std::uint64_t{0};

  Entry& entry_of(std::uint64_t pair) {
    Entry& found = find(pair);
    if (found.pair == pair) return found;
    found.pair = pair;
    if (2 * ++count_ <= entries_.size()) return found;
    grow();
    return find(pair);
  }

  /// The entry of a pair, or an empty one.
  Entry& find(std::uint64_t pair) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = static_cast<std::size_t>((pair * 0x9E37'79B9'7F4A'7C15u) >> 32u) & mask;
    while (entries_[at].pair != pair && entries_[at].pair != kNoPair) at = (at + 1) & mask;
    return entries_[at];
  }

  void grow() {
    std::vector<Entry> before(2 * entries_.size());
    before.swap(entries_);
    for (const Entry& entry : before)
      if (entry.pair != kNoPair) find(entry.pair) = entry;
  }

  std::vector<Entry> entries_;  ///< A power of two.
  std::size_t count_ = 0;
};

}  // namespace sunder::particles
