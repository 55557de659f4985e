// Memory of exceptions that are thrown, for libc++abi's cxa_exception.cpp. A small reserve serves
// std::bad_alloc when memory has run out.

#include <cstddef>
#include <cstdlib>
#include <stdlib.h>

namespace __cxxabiv1 {

namespace {

constexpr std::size_t kReserve = 512;
alignas(16) unsigned char reserve[kReserve];
bool is_reserve_in_use = false;

}  // namespace

void* __aligned_malloc_with_fallback(std::size_t size) {
  if (void* const memory = aligned_alloc(16, (size + 15) / 16 * 16)) return memory;
  if (is_reserve_in_use || size > kReserve) return nullptr;
  is_reserve_in_use = true;
  return reserve;
}
void* __calloc_with_fallback(std::size_t count, std::size_t size) {
  return std::calloc(count, size);
}
void __aligned_free_with_fallback(void* memory) {
  if (memory == reserve)
    is_reserve_in_use = false;
  else
    std::free(memory);
}
void __free_with_fallback(void* memory) { std::free(memory); }

}  // namespace __cxxabiv1
