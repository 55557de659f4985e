#include "tear/surface/scratch_memory.h"

#include <algorithm>
#include <new>

namespace sunder::tear {
namespace {

constexpr std::size_t kLeastBlock = 64 * 1024;

}  // namespace

void ScratchMemory::reset() {
  used_ = 0;
  if (blocks_.size() < 2) return;
  // Replaces several blocks by one, so that the same operation finds room in it next time.
  const std::size_t total = bytes();
  blocks_.clear();
  try {
    add_block(total);
  } catch (const std::bad_alloc&) {  // the memory is allocated when it is needed
  }
}

std::size_t ScratchMemory::bytes() const {
  std::size_t total = 0;
  for (const Block& block : blocks_) total += block.size;
  return total;
}

void ScratchMemory::reserve(std::size_t bytes) {
  blocks_.clear();
  add_block(bytes);
}

void ScratchMemory::add_block(std::size_t size) {
  blocks_.push_back({std::unique_ptr<std::byte[]>(new std::byte[size]), size});  // not zeroed
  used_ = 0;
}

void* ScratchMemory::do_allocate(std::size_t bytes, std::size_t alignment) {
  const auto begin_of_next = [&] { return (used_ + alignment - 1) / alignment * alignment; };
  if (blocks_.empty() || begin_of_next() + bytes > blocks_.back().size) {
    add_block(std::max({kLeastBlock, bytes, blocks_.empty() ? 0 : 2 * blocks_.back().size}));
  }
  const std::size_t begin = begin_of_next();
  used_ = begin + bytes;
  return blocks_.back().bytes.get() + begin;
}

void ScratchMemory::do_deallocate(void* memory, std::size_t bytes, std::size_t) {
  // Only the memory that was handed out last can be reused.
  if (!blocks_.empty() &&
      static_cast<std::byte*>(memory) + bytes == blocks_.back().bytes.get() + used_)
    used_ -= bytes;
}

}  // namespace sunder::tear
