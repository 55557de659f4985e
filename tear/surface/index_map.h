#pragma once

#include <sunder/core/index.h>

#include <bit>
#include <cstdint>

#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// A map from indices to numbers, for lookups only: a table with open addressing, in one piece of
/// memory.
class IndexMap {
 public:
  /// @param expected  number of keys for which the table does not grow.
  IndexMap(std::size_t expected, std::pmr::memory_resource& memory)
      : slots_(std::bit_ceil(2 * expected + 8), Slot{}, &memory) {}

  /// @return the number of a key; kNone if it has none.
  [[nodiscard]] Index find(Index key) const {
    for (std::size_t i = place_of(key);; i = (i + 1) & (slots_.size() - 1))
      if (slots_[i].key == key || slots_[i].key == kNone) return slots_[i].number;
  }
  /// Gives a key a number, unless it has one. @return the number that it had before, or kNone.
  Index insert(Index key, Index number) {
    std::size_t i = place_of(key);
    for (; slots_[i].key != kNone; i = (i + 1) & (slots_.size() - 1))
      if (slots_[i].key == key) return slots_[i].number;
    slots_[i] = {key, number};
    if (2 * ++count_ > slots_.size()) grow();
    return kNone;
  }

 private:
  struct Slot {
    Index key = kNone, number = kNone;
  };

  /// The upper bits of a product with an odd number near 2^32 / 1.618: keys that follow one another
  /// get places far apart. Knuth, The Art of Computer Programming, volume 3, section 6.4.
  [[nodiscard]] std::size_t place_of(Index key) const {
    return (std::uint64_t{key * 2654435769u} * slots_.size()) >> 32;
  }
  void grow() {
    ScratchVector<Slot> old(2 * slots_.size(), Slot{}, slots_.get_allocator());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.key == kNone) continue;
      std::size_t i = place_of(slot.key);
      while (slots_[i].key != kNone) i = (i + 1) & (slots_.size() - 1);
      slots_[i] = slot;
    }
  }

  ScratchVector<Slot> slots_;  ///< A power of two, at least half of them free.
  std::size_t count_ = 0;
};

}  // namespace sunder::tear
