#pragma once

namespace sunder {

/// Prefetches memory that will be read soon. Does nothing if the compiler has no such instruction.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#endif
}

}  // namespace sunder
