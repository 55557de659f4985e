#pragma once

#include <sunder/core/index.h>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace sunder::particles {

/// One bit per element.
class Bits {
 public:
  /// Keeps the bits of elements that stay; new ones are 0.
  void resize(Index count) {
    words_.resize((std::size_t{count} + 63) / 64, 0);
    if (count % 64 != 0) words_.back() &= (std::uint64_t{1} << (count % 64)) - 1;
    count_ = count;
  }
  [[nodiscard]] std::size_t memory_bytes() const { return words_.capacity() * sizeof(words_[0]); }
  [[nodiscard]] Index size() const { return count_; }
  [[nodiscard]] bool operator[](Index i) const { return ((words_[i / 64] >> (i % 64)) & 1) != 0; }
  /// @return whether the bit changed.
  bool set(Index i, bool value) {
    std::uint64_t& word = words_[i / 64];
    const std::uint64_t before = word, bit = std::uint64_t{1} << (i % 64);
    word = value ? before | bit : before & ~bit;
    return word != before;
  }
  /// Sets each bit to value(i), a word at a time.
  template <class Value>
  void set_all(Value value) {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      const Index first = static_cast<Index>(64 * w), count = std::min<Index>(64, count_ - first);
      std::uint64_t word = 0;
      for (Index i = 0; i < count; ++i) word |= std::uint64_t{value(first + i) ? 1u : 0u} << i;
      words_[w] = word;
    }
  }
  /// Sets all bits to 0, and calls visit(i) for each one of an element in [first, last], ascending;
  /// the others are 0. O(last - first).
  template <class Visit>
  void take_ones(Index first, Index last, Visit visit) {
    if (first > last) return;
    for (std::size_t w = first / 64; w <= last / 64; ++w)
      for (std::uint64_t word = std::exchange(words_[w], 0); word != 0; word &= word - 1)
        visit(static_cast<Index>(64 * w) + static_cast<Index>(std::countr_zero(word)));
  }
  /// Calls visit(first, end) for each run of ones, ascending. O(elements / 64 + runs).
  template <class Visit>
  void for_each_run(Visit visit) const {
    for (Index at = next(0, false); at < count_;) {
      const Index end = next(at, true);
      visit(at, end);
      at = next(end, false);
    }
  }

 private:
  /// The first element from `at` on whose bit is 1 or, if `inverted`, 0; size() if there is none.
  [[nodiscard]] Index next(Index at, bool inverted) const {
    const std::uint64_t flip = inverted ? ~std::uint64_t{0} : 0;
    for (std::size_t w = at / 64; w < words_.size(); ++w) {
      std::uint64_t word = words_[w] ^ flip;
      if (w == at / 64) word &= ~std::uint64_t{0} << (at % 64);
      if (word != 0)
        return std::min(count_,
                        static_cast<Index>(64 * w) + static_cast<Index>(std::countr_zero(word)));
    }
    return count_;
  }

  std::vector<std::uint64_t> words_;
  Index count_ = 0;
};

}  // namespace sunder::particles
