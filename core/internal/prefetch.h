#pragma once

namespace sunder {

/// Asks for memory that will be read soon. A hint, where the compiler knows how to give it.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#endif
}

}  // namespace sunder
