#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <vector>

namespace sunder::tear {

/// Memory for data that lives no longer than one operation. It is handed out from one block,
/// released all at once, and kept: an operation like one before it allocates nothing.
class ScratchMemory final : public std::pmr::memory_resource {
 public:
  /// Reserves `bytes`. An operation that needs more allocates it, once: it is kept.
  void reserve(std::size_t bytes);

  /// Releases all that was handed out.
  void reset();
  /// Size of all blocks.
  [[nodiscard]] std::size_t bytes() const;

  /// Releases at its end what was handed out during its life: it must outlive what lies there. So
  /// the steps of an operation use the same memory one after the other.
  class Frame {
   public:
    explicit Frame(ScratchMemory& memory)
        : memory_(memory), blocks_(memory.blocks_.size()), used_(memory.used_) {}
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    ~Frame() { memory_.used_ = memory_.blocks_.size() == blocks_ ? used_ : 0; }

   private:
    ScratchMemory& memory_;
    std::size_t blocks_, used_;
  };

 private:
  struct Block {
    std::unique_ptr<std::byte[]> bytes;
    std::size_t size = 0;
  };

  void add_block(std::size_t size);
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::vector<Block> blocks_;  ///< Memory is taken from the last block.
  std::size_t used_ = 0;       ///< Bytes of the last block.
};

template <class T>
using ScratchVector = std::pmr::vector<T>;

}  // namespace sunder::tear
