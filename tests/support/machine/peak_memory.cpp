#include "support/machine/peak_memory.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <malloc.h>
#include <new>

#if defined(__SANITIZE_ADDRESS__)
#define SUNDER_MEASURES_MEMORY 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SUNDER_MEASURES_MEMORY 0
#endif
#endif
#ifndef SUNDER_MEASURES_MEMORY
#define SUNDER_MEASURES_MEMORY 1
#endif

namespace {

std::atomic<std::uint64_t> held = 0, peak = 0;

#if SUNDER_MEASURES_MEMORY
void* allocate(std::size_t bytes, std::size_t alignment) {
  bytes = std::max<std::size_t>(bytes, 1);
  void* const memory =
      alignment <= alignof(std::max_align_t)
          ? std::malloc(bytes)
          : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  const std::uint64_t now = held += malloc_usable_size(memory);
  std::uint64_t most = peak;
  while (most < now && !peak.compare_exchange_weak(most, now)) {
  }
  return memory;
}

void release(void* memory) {
  if (memory != nullptr) held -= malloc_usable_size(memory);
  std::free(memory);
}
#endif

}  // namespace

#if SUNDER_MEASURES_MEMORY
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

PeakMemory::PeakMemory() : before_(held) { peak = before_; }
std::uint64_t PeakMemory::bytes() const { return peak - before_; }
bool PeakMemory::is_measured() { return SUNDER_MEASURES_MEMORY != 0; }

}  // namespace sunder::test
