#pragma once

#include <sunder/core/index.h>

#include <cstdint>
#include <numeric>

#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// Union-find over the indices below a count.
class DisjointSets {
 public:
  DisjointSets(Index count, std::pmr::memory_resource& memory) : parent_(count, &memory) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The root of `into` stays a root. @return whether there were two sets.
  bool unite(Index into, Index from) {
    const Index a = find(into), b = find(from);
    parent_[b] = a;
    return a != b;
  }
  /// The lesser root stays a root.
  void unite_with_lesser(Index i, Index j) {
    if (parent_[i] == parent_[j]) return;  // mostly
    const Index a = find(i), b = find(j);
    parent_[a < b ? b : a] = a < b ? a : b;
  }

 private:
  ScratchVector<Index> parent_;
};

}  // namespace sunder::tear
