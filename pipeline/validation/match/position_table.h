#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace sunder::validation {

/// Finds vertices by their place: a hash table with open addressing. Places are equal if they round
/// to the same floats, so that double arithmetic around a stored float position finds it again.
class PositionTable {
 public:
  explicit PositionTable(std::size_t capacity)
      : slots_(std::bit_ceil(2 * capacity + 1)), mask_(slots_.size() - 1) {}

  /// Adds an index at a place; several may stand at one place.
  void insert(const Vec3d& place, Index index) {
    const Vec3f key = rounded(place);
    std::size_t slot = hash(key) & mask_;
    while (slots_[slot].index != kNone) slot = (slot + 1) & mask_;
    slots_[slot] = {key, index};
  }

  /// Calls visit(index) for all at that place, in the order of their insertion, until it returns
  /// true.
  template <class Visit>
  void find(const Vec3d& place, const Visit& visit) const {
    const Vec3f key = rounded(place);
    for (std::size_t slot = hash(key) & mask_; slots_[slot].index != kNone;
         slot = (slot + 1) & mask_)
      if (slots_[slot].place == key && visit(slots_[slot].index)) return;
  }

 private:
  struct Slot {
    Vec3f place = Vec3f::Zero();
    Index index = kNone;
  };

  /// -0 + 0 = +0: the two compare equal, so their hashes must agree.
  static Vec3f rounded(const Vec3d& place) { return place.cast<float>() + Vec3f::Zero(); }

  static std::uint64_t hash(const Vec3f& key) {
    std::uint64_t h = 0x9E3779B97F4A7C15u;
    for (int i = 0; i < 3; ++i) {
      h = (h ^ std::bit_cast<std::uint32_t>(key[i])) * 0xFF51AFD7ED558CCDu;
      h ^= h >> 32;
    }
    return h;
  }

  std::vector<Slot> slots_;
  std::size_t mask_;
};

}  // namespace sunder::validation
