#include "io/contained_import/memory_limit.h"

#include <algorithm>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#if defined(__linux__) && defined(__has_include)
#if __has_include(<linux/capability.h>)
#include <linux/capability.h>
#define SUNDER_HAS_CAPABILITIES 1
#endif
#endif

namespace sunder::contained_import {

std::uint64_t import_memory_of(std::uint64_t bytes, const LoadOptions& options) {
  constexpr std::uint64_t kLeast = std::uint64_t{256} << 20, kPerByte = 64;
  const std::uint64_t wanted = bytes > options.import_memory / kPerByte
                                   ? options.import_memory
                                   : std::max(kLeast, bytes * kPerByte);
  return std::min(wanted, options.import_memory);
}

bool can_raise_memory_limit() {
#if defined(SUNDER_HAS_CAPABILITIES)
  if (geteuid() != 0) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3] = {};
  return syscall(SYS_capget, &header, sets) == 0 &&
         (sets[CAP_SYS_RESOURCE / 32].effective >> (CAP_SYS_RESOURCE % 32) & 1) != 0;
#else
  return true;
#endif
}

void raise_memory_limit([[maybe_unused]] pid_t process, [[maybe_unused]] std::uint64_t by) {
#if defined(__linux__)
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (by == 0 || prlimit(process, resource, nullptr, &limit) != 0 ||
        limit.rlim_cur == RLIM_INFINITY)
      continue;
    limit.rlim_cur = std::min(limit.rlim_cur + static_cast<rlim_t>(by), limit.rlim_max);
    prlimit(process, resource, &limit, nullptr);
  }
#endif
}

}  // namespace sunder::contained_import
