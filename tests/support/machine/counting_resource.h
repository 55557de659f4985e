#pragma once

#include <atomic>
#include <cstdlib>
#include <memory_resource>
#include <new>

namespace sunder::test {

/// Counts what is allocated from it; can run out.
class CountingResource : public std::pmr::memory_resource {
 public:
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  void limit(std::size_t bytes) { most_ = bytes; }

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    if (bytes_ + bytes > most_) throw std::bad_alloc();
    bytes_ += bytes;
    ++blocks_;
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  }
  void do_deallocate(void* memory, std::size_t bytes, std::size_t) override {
    bytes_ -= bytes;
    --blocks_;
    std::free(memory);
  }
  [[nodiscard]] bool do_is_equal(const memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::atomic<std::size_t> bytes_ = 0, blocks_ = 0;
  std::atomic<std::size_t> most_ = ~std::size_t{0};
};

}  // namespace sunder::test
