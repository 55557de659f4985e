#pragma once

#include <memory_resource>

namespace sunder::c {

/// What sunder_set_allocator() named last; null: the heap.
[[nodiscard]] std::pmr::memory_resource* allocator();

}  // namespace sunder::c
