#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace sunder::skinning {

/// The slots of the block under construction. It needs no sorting, because blocks at a cap may
/// name hundreds of influences and a few dozen slots.
class SlotSet {
 public:
  /// Nothing else allocates. @throws std::bad_alloc
  void make_room(std::size_t slot_count) {
    marks_.assign((slot_count + 63) / 64, 0);
    places_.resize(slot_count);
    slots_.reserve(slot_count);
  }
  void clear() {
    for (const std::uint16_t slot : slots_) marks_[slot / 64] = 0;
    slots_.clear();
    first_ = static_cast<std::uint32_t>(marks_.size());
    end_ = 0;
  }
  /// finish() has to follow.
  void insert(std::uint32_t slot) {
    const std::uint32_t word = slot / 64;
    marks_[word] |= std::uint64_t{1} << (slot % 64);
    first_ = std::min(first_, word);
    end_ = std::max(end_, word + 1);
  }
  /// Lists the slots that were inserted since clear().
  void finish() {
    for (std::uint32_t word = first_; word < end_; ++word)
      for (std::uint64_t marks = marks_[word]; marks != 0; marks &= marks - 1) {
        const auto slot = static_cast<std::uint16_t>(
            64 * word + static_cast<std::uint32_t>(std::countr_zero(marks)));
        places_[slot] = static_cast<std::uint16_t>(slots_.size());
        slots_.push_back(slot);
      }
  }

  /// Ascending.
  [[nodiscard]] std::span<const std::uint16_t> slots() const { return slots_; }
  /// The place of one of them in slots().
  [[nodiscard]] std::size_t place(std::uint32_t slot) const { return places_[slot]; }

 private:
  std::vector<std::uint64_t> marks_;  ///< One bit per slot.
  std::vector<std::uint16_t> places_;
  std::vector<std::uint16_t> slots_;
  std::uint32_t first_ = 0, end_ = 0;  ///< Words that may have marks.
};

}  // namespace sunder::skinning
