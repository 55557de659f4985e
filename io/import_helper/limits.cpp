#include <algorithm>
#include <cstdio>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "io/import_helper/sandbox.h"
#include "io/import_helper/under_sanitizer.h"

namespace sunder::import_helper {
namespace {

constexpr std::uint64_t kStackBytes = std::uint64_t{8} << 20;
constexpr std::uint64_t kOpenFiles = 64;

void set_limit(decltype(RLIMIT_CPU) resource, std::uint64_t soft, std::uint64_t hard) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  if (limit.rlim_max == RLIM_INFINITY || hard < limit.rlim_max)
    limit.rlim_max = static_cast<rlim_t>(hard);
  limit.rlim_cur = std::min(static_cast<rlim_t>(soft), limit.rlim_max);
  setrlimit(resource, &limit);
}

struct InUse {
  std::uint64_t address_space = 0, data = 0;
};

/// Bytes of the program and its libraries. Nothing of the model has been read yet.
[[maybe_unused]] InUse memory_in_use() {
  constexpr std::uint64_t kIfUnknown = std::uint64_t{64} << 20;
  unsigned long long all = 0, data = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(statm, "%llu %*u %*u %*u %*u %llu", &all, &data) != 2) all = 0;
    std::fclose(statm);
  }
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return all == 0 ? InUse{std::uint64_t{65} << 30, kIfUnknown} : InUse{all * page, data * page};
}

}  // namespace

void set_limits(const SandboxLimits& limits) {
  set_limit(RLIMIT_CORE, 0, 0);
  set_limit(RLIMIT_FSIZE, 0, 0);
  set_limit(RLIMIT_NOFILE, kOpenFiles, kOpenFiles);
  set_limit(RLIMIT_STACK, kStackBytes, kStackBytes);
  set_limit(RLIMIT_CPU, limits.cpu_seconds, std::uint64_t{limits.cpu_seconds} + 1);
#if !defined(SUNDER_UNDER_SANITIZER)
  // The region of allocation.cpp is address space in use, and no data until it is written.
  const InUse used = memory_in_use();
  set_limit(RLIMIT_AS, used.address_space + limits.memory,
            used.address_space + limits.largest_memory);
  set_limit(RLIMIT_DATA, used.data + limits.memory, used.data + limits.largest_memory);
#endif
#if defined(__linux__)
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
#endif
}

}  // namespace sunder::import_helper
