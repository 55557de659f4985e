#pragma once

#include <span>

#include "core/internal/sort_by_index.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// As sunder::sort_by_index(), in scratch memory.
template <class Item, class KeyOf>
void sort_by_index(ScratchVector<Item>& items, KeyOf key_of, ScratchMemory& memory) {
  const ScratchMemory::Frame memory_of_step(memory);
  ScratchVector<Item> room(&memory);
  sunder::sort_by_index(std::span<Item>(items), key_of, [&] {
    room.resize(items.size());
    return std::span<Item>(room);
  });
}

}  // namespace sunder::tear
