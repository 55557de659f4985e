// Counts the allocations of the whole process: replaces the ordinary forms of operator new, which
// the others call.
#include "support/machine/allocation_count.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

// The address sanitizer has operators of its own and needs all of them, so nothing is counted with
// it.
#if defined(__SANITIZE_ADDRESS__)
#define SUNDER_COUNTS_ALLOCATIONS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SUNDER_COUNTS_ALLOCATIONS 0
#endif
#endif
#ifndef SUNDER_COUNTS_ALLOCATIONS
#define SUNDER_COUNTS_ALLOCATIONS 1
#endif

namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

std::atomic<std::uint64_t> allocations = 0;
std::atomic<std::uint64_t> first_failing = kNever;
std::atomic<std::uint64_t> live = 0;

#if SUNDER_COUNTS_ALLOCATIONS
std::size_t size_of([[maybe_unused]] void* memory) {
#if defined(__GLIBC__)
  return malloc_usable_size(memory);
#else
  return 0;
#endif
}

void release(void* memory) {
  live.fetch_sub(size_of(memory), std::memory_order_relaxed);
  std::free(memory);
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (allocations.fetch_add(1, std::memory_order_relaxed) >= first_failing) throw std::bad_alloc();
  if (bytes == 0) bytes = 1;
  void* const memory =
      alignment <= alignof(std::max_align_t)
          ? std::malloc(bytes)
          : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  live.fetch_add(size_of(memory), std::memory_order_relaxed);
  return memory;
}
#endif

}  // namespace

#if SUNDER_COUNTS_ALLOCATIONS
void* operator new(std::size_t bytes) { return allocate(bytes, 1); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
#endif

namespace sunder::test {

std::uint64_t allocation_count() { return allocations.load(std::memory_order_relaxed); }

std::uint64_t live_bytes() { return live.load(std::memory_order_relaxed); }

FailingAllocations::FailingAllocations(std::uint64_t count) {
  first_failing = allocation_count() + count;
}
FailingAllocations::~FailingAllocations() { first_failing = kNever; }
bool FailingAllocations::are_possible() { return SUNDER_COUNTS_ALLOCATIONS != 0; }

}  // namespace sunder::test
