#include "bindings/c/allocator.h"

#include <atomic>
#include <memory>

#include "bindings/c/errors.h"

#if SUNDER_C_ALLOCATOR
#include <sunder/core/memory_operators.h>
#endif

namespace sunder::c {
namespace {

/// Memory of the caller.
class CallersMemory : public std::pmr::memory_resource {
 public:
  CallersMemory(sunder_allocate allocate, sunder_release release, void* context)
      : allocate_(allocate), release_(release), context_(context) {}

  /// The one that was named before. Blocks may still have to go back to it, so all are kept.
  CallersMemory* before = nullptr;

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    void* const memory = allocate_(context_, bytes, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override {
    release_(context_, memory, bytes, alignment);
  }
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  sunder_allocate allocate_;
  sunder_release release_;
  void* context_;
};

std::atomic<std::pmr::memory_resource*> current_allocator = nullptr;
std::atomic<CallersMemory*> newest = nullptr;

}  // namespace

std::pmr::memory_resource* allocator() { return current_allocator.load(); }

}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_status sunder_set_allocator(sunder_allocate allocate, sunder_release release,
                                   void* context) {
  return guarded([&]() -> sunder_status {
    if (!SUNDER_C_ALLOCATOR)
      return fail(SUNDER_UNSUPPORTED_FEATURE, sunder::kNone, "this build has no allocator hook");
    if (allocate == nullptr && release != nullptr) return null_pointer("allocate");
    if (allocate != nullptr && release == nullptr) return null_pointer("release");
    if (allocate == nullptr) {
      current_allocator = nullptr;
      return SUNDER_OK;
    }
    const sunder::MemoryScope heap(nullptr);
    auto made = std::make_unique<CallersMemory>(allocate, release, context);
    CallersMemory* const kept = made.release();
    kept->before = newest.exchange(kept);
    current_allocator = kept;
    return SUNDER_OK;
  });
}

}  // extern "C"
