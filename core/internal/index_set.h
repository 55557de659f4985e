#pragma once

#include <sunder/core/index.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace sunder {

/// A set of indices below a limit, one bit each: it lists them in ascending order without sorting,
/// and knows the place of each in that list.
class IndexSet {
 public:
  /// @throws std::bad_alloc
  explicit IndexSet(Index limit) : words_(limit / kBits + 1) {}

  /// @return whether it is new.
  bool insert(Index index) {
    std::uint64_t& bits = words_[index / kBits].bits;
    const std::uint64_t bit = std::uint64_t{1} << index % kBits;
    const bool is_new = (bits & bit) == 0;
    bits |= bit;
    return is_new;
  }

  /// The indices, ascending. After it place_of() may be called. @throws std::bad_alloc
  [[nodiscard]] std::vector<Index> list() {
    Index count = 0;
    for (Word& word : words_) {
      word.before = count;
      count += static_cast<Index>(std::popcount(word.bits));
    }
    std::vector<Index> values;
    values.reserve(count);
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t bits = words_[w].bits; bits != 0; bits &= bits - 1)
        values.push_back(static_cast<Index>(kBits * w) +
                         static_cast<Index>(std::countr_zero(bits)));
    return values;
  }
  /// The place in list() of an index that is in the set.
  [[nodiscard]] Index place_of(Index index) const {
    const Word& word = words_[index / kBits];
    const std::uint64_t below = word.bits & ((std::uint64_t{1} << index % kBits) - 1);
    return word.before + static_cast<Index>(std::popcount(below));
  }

 private:
  static constexpr Index kBits = 64;
  struct Word {
    std::uint64_t bits = 0;
    Index before = 0;  ///< Indices of the set in earlier words.
  };
  std::vector<Word> words_;
};

}  // namespace sunder
