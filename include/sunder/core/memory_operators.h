#pragma once

// Defines the global operators new and delete of a program, so that MemoryScope takes effect:
// include it in exactly one source file. Each block has a small head that names its resource.

#include <sunder/core/memory_scope.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace sunder::memory_operators {

/// Precedes each block.
struct Head {
  std::pmr::memory_resource* memory;
  std::size_t bytes;  ///< Of the block with its head.
};
static_assert(sizeof(Head) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);

/// The distance from the beginning of the memory to the block.
constexpr std::size_t room_for_head(std::size_t alignment) {
  return std::max<std::size_t>(alignment, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}

inline void* from_heap(std::size_t bytes, std::size_t alignment) noexcept {
  if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) return std::malloc(bytes);
#if defined(_WIN32)
  return _aligned_malloc(bytes, alignment);
#else
  return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
#endif
}

inline void to_heap(void* begin, std::size_t alignment) noexcept {
#if defined(_WIN32)
  if (alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__) return _aligned_free(begin);
#else
  (void)alignment;
#endif
  std::free(begin);
}

/// @throws std::bad_alloc
inline void* allocate(std::size_t bytes, std::size_t alignment) {
  const std::size_t room = room_for_head(alignment);
  if (bytes > static_cast<std::size_t>(-1) / 2) throw std::bad_alloc();
  bytes += room;
  std::pmr::memory_resource* const memory = MemoryScope::current();
  void* begin = nullptr;
  if (memory == nullptr) {
    begin = from_heap(bytes, room);
  } else {
    const MemoryScope heap(nullptr);  // a resource may allocate for itself
    begin = memory->allocate(bytes, room);
  }
  if (begin == nullptr) throw std::bad_alloc();
  auto* const block = static_cast<std::byte*>(begin) + room;
  new (block - sizeof(Head)) Head{memory, bytes};
  return block;
}

inline void release(void* block, std::size_t alignment) noexcept {
  if (block == nullptr) return;
  const std::size_t room = room_for_head(alignment);
  const Head head = *reinterpret_cast<Head*>(static_cast<std::byte*>(block) - sizeof(Head));
  void* const begin = static_cast<std::byte*>(block) - room;
  if (head.memory == nullptr) {
    to_heap(begin, room);
    return;
  }
  const MemoryScope heap(nullptr);
  head.memory->deallocate(begin, head.bytes, room);
}

inline void* allocate_or_null(std::size_t bytes, std::size_t alignment) noexcept {
  try {
    return allocate(bytes, alignment);
  } catch (...) {
    return nullptr;
  }
}

}  // namespace sunder::memory_operators

void* operator new(std::size_t bytes) { return sunder::memory_operators::allocate(bytes, 1); }
void* operator new[](std::size_t bytes) { return sunder::memory_operators::allocate(bytes, 1); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return sunder::memory_operators::allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return sunder::memory_operators::allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return sunder::memory_operators::allocate_or_null(bytes, 1);
}
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept {
  return sunder::memory_operators::allocate_or_null(bytes, 1);
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return sunder::memory_operators::allocate_or_null(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment,
                     const std::nothrow_t&) noexcept {
  return sunder::memory_operators::allocate_or_null(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* block) noexcept { sunder::memory_operators::release(block, 1); }
void operator delete[](void* block) noexcept { sunder::memory_operators::release(block, 1); }
void operator delete(void* block, std::size_t) noexcept {
  sunder::memory_operators::release(block, 1);
}
void operator delete[](void* block, std::size_t) noexcept {
  sunder::memory_operators::release(block, 1);
}
void operator delete(void* block, std::align_val_t alignment) noexcept {
  sunder::memory_operators::release(block, static_cast<std::size_t>(alignment));
}
void operator delete[](void* block, std::align_val_t alignment) noexcept {
  sunder::memory_operators::release(block, static_cast<std::size_t>(alignment));
}
void operator delete(void* block, std::size_t, std::align_val_t alignment) noexcept {
  sunder::memory_operators::release(block, static_cast<std::size_t>(alignment));
}
void operator delete[](void* block, std::size_t, std::align_val_t alignment) noexcept {
  sunder::memory_operators::release(block, static_cast<std::size_t>(alignment));
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  sunder::memory_operators::release(block, 1);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
  sunder::memory_operators::release(block, 1);
}
void operator delete(void* block, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  sunder::memory_operators::release(block, static_cast<std::size_t>(alignment));
}
void operator delete[](void* block, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  sunder::memory_operators::release(block, static_cast<std::size_t>(alignment));
}
