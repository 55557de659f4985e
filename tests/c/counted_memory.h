#pragma once

#include <cstdlib>
#include <map>
#include <mutex>
#include <sunder_c.h>

#include <gtest/gtest.h>

namespace sunder::test {

inline bool has_allocator() { return (sunder_features() & SUNDER_FEATURE_ALLOCATOR) != 0; }

/// Counts what it gives and what comes back; refuses what exceeds `left` calls.
class CountedMemory {
 public:
  ~CountedMemory() { EXPECT_DONE(sunder_set_allocator(nullptr, nullptr, nullptr)); }
  void use() { EXPECT_DONE(sunder_set_allocator(allocate, release, this)); }

  [[nodiscard]] std::size_t live() const { return blocks_.size(); }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  std::uint64_t calls = 0, left = ~std::uint64_t{0};

 private:
  struct Block {
    std::uint64_t bytes = 0, alignment = 0;
  };
  static void* allocate(void* context, std::uint64_t bytes, std::uint64_t alignment) {
    CountedMemory& self = *static_cast<CountedMemory*>(context);
    const std::lock_guard lock(self.mutex_);
    ++self.calls;
    if (self.left == 0) return nullptr;
    --self.left;
    void* const memory = std::aligned_alloc(alignment, (bytes + alignment - 1) & ~(alignment - 1));
    EXPECT_TRUE(self.blocks_.emplace(memory, Block{bytes, alignment}).second);
    self.bytes_ += bytes;
    return memory;
  }
  static void release(void* context, void* memory, std::uint64_t bytes, std::uint64_t alignment) {
    CountedMemory& self = *static_cast<CountedMemory*>(context);
    const std::lock_guard lock(self.mutex_);
    const auto found = self.blocks_.find(memory);
    ASSERT_NE(found, self.blocks_.end()) << "it came from elsewhere";
    EXPECT_EQ(found->second.bytes, bytes);
    EXPECT_EQ(found->second.alignment, alignment);
    self.blocks_.erase(found);
    self.bytes_ -= bytes;
    std::free(memory);
  }

  std::mutex mutex_;
  std::map<void*, Block> blocks_;
  std::uint64_t bytes_ = 0;
};

}  // namespace sunder::test
