#pragma once

#include <sunder/core/index.h>

#include <cstddef>
#include <numeric>
#include <vector>

namespace sunder::aim {

/// Elements that are joined into disjoint sets.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), Index{0});
  }

  /// One element of the set, the same for all of it until the next call of join().
  [[nodiscard]] Index set_of(Index element) {
    while (parents_[element] != element) element = parents_[element] = parents_[parents_[element]];
    return element;
  }
  void join(Index a, Index b) { parents_[set_of(a)] = set_of(b); }

 private:
  std::vector<Index> parents_;
};

}  // namespace sunder::aim
