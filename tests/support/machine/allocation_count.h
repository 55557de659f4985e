#pragma once

#include <cstdint>

namespace sunder::test {

/// Number of calls of operator new in this process. A program that links this has its own operator
/// new.
[[nodiscard]] std::uint64_t allocation_count();

/// Bytes that operator new handed out and that were not freed, as the allocator rounds them up. 0
/// where the C library does not tell.
[[nodiscard]] std::uint64_t live_bytes();

/// During the lifetime of an object, operator new throws std::bad_alloc after `count` further
/// calls.
class FailingAllocations {
 public:
  explicit FailingAllocations(std::uint64_t count);
  ~FailingAllocations();
  FailingAllocations(const FailingAllocations&) = delete;
  FailingAllocations& operator=(const FailingAllocations&) = delete;

  /// False under the address sanitizer, which has an operator new of its own.
  [[nodiscard]] static bool are_possible();
};

}  // namespace sunder::test
