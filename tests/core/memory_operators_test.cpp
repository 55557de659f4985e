#include <sunder/core/memory_operators.h>

#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/counting_resource.h"

namespace sunder {
namespace {

using test::CountingResource;

TEST(MemoryScope, nests_and_belongs_to_a_thread) {
  CountingResource outer, inner;
  EXPECT_EQ(MemoryScope::current(), nullptr);
  {
    const MemoryScope one(&outer);
    {
      const MemoryScope two(&inner);
      EXPECT_EQ(MemoryScope::current(), &inner);
      std::thread([] { EXPECT_EQ(MemoryScope::current(), nullptr); }).join();
    }
    EXPECT_EQ(MemoryScope::current(), &outer);
  }
  EXPECT_EQ(MemoryScope::current(), nullptr);
}

TEST(MemoryScope, each_block_returns_to_its_resource) {
  CountingResource memory;
  std::unique_ptr<std::vector<int>> values;
  struct alignas(64) Wide {
    float values[16];
  };
  std::unique_ptr<Wide> wide;
  {
    const MemoryScope scope(&memory);
    values = std::make_unique<std::vector<int>>(1000);
    wide = std::make_unique<Wide>();
  }
  EXPECT_EQ(memory.blocks(), 3u);
  EXPECT_GE(memory.bytes(), 1000 * sizeof(int) + sizeof(Wide));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(wide.get()) % 64, 0u);
  values->resize(5000);  // outside: from the heap
  EXPECT_EQ(memory.blocks(), 2u);
  values.reset();
  wide.reset();
  EXPECT_EQ(memory.bytes(), 0u);
  EXPECT_EQ(memory.blocks(), 0u);
}

/// Makes and frees a block by each pair of operators. Volatile, so that no pair is left out.
void use_all_operators(std::align_val_t alignment) {
  using Free = void (*)(void*, std::align_val_t);
  const auto check = [&](void* block, Free free) {
    void* volatile kept = block;
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(kept) % static_cast<std::size_t>(alignment), 0u);
    free(kept, alignment);
  };
  constexpr std::nothrow_t quiet = std::nothrow;
  check(operator new(24, alignment),
        [](void* block, std::align_val_t by) { operator delete(block, by); });
  check(operator new[](24, alignment),
        [](void* block, std::align_val_t by) { operator delete[](block, by); });
  check(operator new(24, alignment, quiet),
        [](void* block, std::align_val_t by) { operator delete(block, by, std::nothrow); });
  check(operator new[](24, alignment, quiet),
        [](void* block, std::align_val_t by) { operator delete[](block, by, std::nothrow); });
  check(operator new(24, alignment),
        [](void* block, std::align_val_t by) { operator delete (block, std::size_t{24}, by); });
  check(operator new[](24, alignment),
        [](void* block, std::align_val_t by) { operator delete[](block, std::size_t{24}, by); });
}

void use_all_operators() {
  using Free = void (*)(void*);
  const auto check = [](void* block, Free free) {
    void* volatile kept = block;
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(kept) % __STDCPP_DEFAULT_NEW_ALIGNMENT__, 0u);
    free(kept);
  };
  check(operator new(24), [](void* block) { operator delete(block); });
  check(operator new[](24), [](void* block) { operator delete[](block); });
  check(operator new(24, std::nothrow), [](void* block) { operator delete(block, std::nothrow); });
  check(operator new[](24, std::nothrow),
        [](void* block) { operator delete[](block, std::nothrow); });
  check(operator new(24), [](void* block) { operator delete (block, std::size_t{24}); });
  check(operator new[](24), [](void* block) { operator delete[](block, std::size_t{24}); });
}

TEST(MemoryOperators, every_pair_balances_and_is_aligned) {
  CountingResource memory;
  for (std::pmr::memory_resource* const resource :
       {static_cast<std::pmr::memory_resource*>(&memory),
        static_cast<std::pmr::memory_resource*>(nullptr)}) {
    const MemoryScope scope(resource);
    use_all_operators();
    for (const std::size_t alignment : {1u, 16u, 64u, 4096u})
      use_all_operators(std::align_val_t(alignment));
    operator delete(nullptr);
  }
  EXPECT_EQ(memory.blocks(), 0u);
  EXPECT_EQ(memory.bytes(), 0u);
}

TEST(MemoryOperators, say_that_there_is_no_memory) {
  constexpr std::size_t kFarTooMuch = ~std::size_t{0} - 8;
  const volatile std::size_t too_much = kFarTooMuch;
  EXPECT_THROW(operator delete(operator new(too_much)), std::bad_alloc);
  EXPECT_EQ(operator new(too_much, std::nothrow), nullptr);
  EXPECT_EQ(operator new[](too_much, std::align_val_t(64), std::nothrow), nullptr);
  CountingResource memory;
  memory.limit(1000);
  const MemoryScope scope(&memory);
  EXPECT_EQ(operator new(2000, std::nothrow), nullptr);
  EXPECT_EQ(memory.blocks(), 0u);
}

}  // namespace
}  // namespace sunder
