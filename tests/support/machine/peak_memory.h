#pragma once

#include <cstdint>

namespace sunder::test {

/// The most memory that this process held at one time, through operator new, since the object was
/// made. A program that links this has its own operator new.
class PeakMemory {
 public:
  PeakMemory();
  /// Bytes beyond those that were held at the beginning.
  [[nodiscard]] std::uint64_t bytes() const;

  /// False under the address sanitizer, which has an operator new of its own.
  [[nodiscard]] static bool is_measured();

 private:
  std::uint64_t before_ = 0;
};

}  // namespace sunder::test
