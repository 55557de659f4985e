// operator new and delete of the helper process, also for assimp. assimp makes millions of small
// objects, mostly to keep them: with glibc's malloc they are up to half of its time. Here a small
// object takes the next bytes of one region, or those of an object of the same size that was
// deleted. The process has one thread and ends after one model.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "io/import_helper/under_sanitizer.h"

#if defined(__linux__) && defined(__LP64__) && !defined(SUNDER_UNDER_SANITIZER)

#include <sys/mman.h>

namespace {

constexpr std::size_t kStep = 16;  ///< Sizes are multiples of it, and so is every address.
constexpr std::size_t kLargestSmall = 1024;
/// Address space, not memory. Writable in chunks, which the limits of the process count.
constexpr std::size_t kReserved = std::size_t{64} << 30;
constexpr std::size_t kChunk = std::size_t{2} << 20;

struct FreeObject {
  FreeObject* next;
};

struct Region {
  char* begin = nullptr;
  char* next = nullptr;
  char* writable = nullptr;  ///< End of the chunks that can be used.
  char* end = nullptr;
  bool is_tried = false;
  FreeObject* free_of_size[kLargestSmall / kStep + 1] = {};
};
constinit Region region;

bool reserve() {
  region.is_tried = true;
  void* const all = mmap(nullptr, kReserved + kChunk, PROT_NONE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (all == MAP_FAILED) return false;  // a limit of the caller; malloc() does it all
  const auto address = reinterpret_cast<std::uintptr_t>(all);
  region.begin = static_cast<char*>(all) + (kChunk - address % kChunk) % kChunk;
  region.next = region.writable = region.begin;
  region.end = region.begin + kReserved;
  madvise(region.begin, kReserved, MADV_HUGEPAGE);
  return true;
}

/// @return null if there is no memory.
void* from_region(std::size_t size) {
  if (region.next + size > region.writable) {
    if (region.writable + kChunk > region.end ||
        mprotect(region.writable, kChunk, PROT_READ | PROT_WRITE) != 0)
      return nullptr;
    region.writable += kChunk;
  }
  void* const object = region.next;
  region.next += size;
  return object;
}

bool is_in_region(const void* object) { return object >= region.begin && object < region.writable; }

/// Memory from `allocate`, or the end that main.cpp has set for this case.
template <class Allocate>
void* or_end(Allocate allocate) {
  for (;;) {
    if (void* const object = allocate()) return object;
    const std::new_handler no_memory = std::get_new_handler();
    if (no_memory == nullptr) throw std::bad_alloc();
    no_memory();
  }
}

void* by_malloc(std::size_t size) {
  return or_end([size] { return std::malloc(size == 0 ? 1 : size); });
}

}  // namespace

void* operator new(std::size_t size) {
  if (size > kLargestSmall) return by_malloc(size);
  if (region.begin == nullptr && (region.is_tried || !reserve())) return by_malloc(size);
  const std::size_t steps = size == 0 ? 1 : (size + kStep - 1) / kStep;
  FreeObject*& free = region.free_of_size[steps];
  if (free == nullptr) return or_end([steps] { return from_region(steps * kStep); });
  void* const object = free;
  free = free->next;
  return object;
}

void operator delete(void* object, std::size_t size) noexcept {
  if (!is_in_region(object)) return std::free(object);
  // An object may be deleted as one of a smaller base class, but not of a larger one.
  FreeObject*& free = region.free_of_size[size == 0 ? 1 : (size + kStep - 1) / kStep];
  free = new (object) FreeObject{free};
}

/// The size is not known, so the object's bytes are lost.
void operator delete(void* object) noexcept {
  if (!is_in_region(object)) std::free(object);
}

// Arrays are deleted without their size.
void* operator new[](std::size_t size) { return by_malloc(size); }
void operator delete[](void* array) noexcept { operator delete(array); }
void operator delete[](void* array, std::size_t) noexcept { operator delete(array); }

#endif
