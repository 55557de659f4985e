#pragma once

#include <cstdint>

namespace sunder::test {

/// How often this process asked operator new for memory. A program that asks this has its own
/// operator new.
[[nodiscard]] std::uint64_t allocation_count();

/// While one of these lives, operator new fails with std::bad_alloc after `count` further calls.
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
