#pragma once

#include <cstdint>

namespace sunder::test {

/// How often this process asked operator new for memory. A program that asks this has its own operator new.
[[nodiscard]] std::uint64_t allocation_count();

}  // namespace sunder::test
