#include <grp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "io/import_helper/sandbox.h"
#include "io/import_helper/under_sanitizer.h"

#if defined(__linux__) && defined(__has_include)
#if __has_include(<linux/capability.h>)
#include <linux/capability.h>
#define SUNDER_HAS_CAPABILITIES 1
#endif
#if __has_include(<linux/landlock.h>) && defined(SYS_landlock_create_ruleset) && \
    !defined(SUNDER_UNDER_SANITIZER)
#include <linux/landlock.h>
#define SUNDER_HAS_LANDLOCK 1
#endif
#endif

namespace sunder::import_helper {
namespace {

constexpr unsigned kNobody = 65'534;

#if defined(SUNDER_HAS_CAPABILITIES)

__user_cap_header_struct own_header() { return {_LINUX_CAPABILITY_VERSION_3, 0}; }

bool has_capability(unsigned number) {
  __user_cap_header_struct header = own_header();
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3] = {};
  return syscall(SYS_capget, &header, sets) == 0 &&
         (sets[number / 32].effective >> (number % 32) & 1) != 0;
}

void drop_capabilities() {
  __user_cap_header_struct header = own_header();
  const __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {};
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  syscall(SYS_capset, &header, none);
}

/// The caller has the capabilities with which this process starts: it must be able to end it.
bool caller_can_end_nobody() { return has_capability(CAP_KILL); }

#else
void drop_capabilities() {}
bool caller_can_end_nobody() { return true; }
#endif

void become_nobody() {
  if (geteuid() != 0 || !caller_can_end_nobody()) return;
  // Groups first: nobody may not change them.
  if (setgroups(0, nullptr) != 0 || setresgid(kNobody, kNobody, kNobody) != 0) return;
  (void)!setresuid(kNobody, kNobody, kNobody);
}

#if defined(SUNDER_HAS_LANDLOCK)
/// The kinds of access that a version of Landlock knows; the headers of the build may be older.
struct Rights {
  std::uint64_t files = 0, ports = 0, scopes = 0;
};

Rights rights_of(long version) {
  // Bits of each version, from linux/landlock.h: 13 in the first, then rename between folders,
  // truncate, and control of devices.
  constexpr std::uint64_t kFirst = (std::uint64_t{1} << 13) - 1;
  Rights rights{kFirst, 0, 0};
  if (version >= 2) rights.files |= std::uint64_t{1} << 13;
  if (version >= 3) rights.files |= std::uint64_t{1} << 14;
  if (version >= 4) rights.ports = 0b11;
  if (version >= 5) rights.files |= std::uint64_t{1} << 15;
  if (version >= 6) rights.scopes = 0b11;  // abstract sockets and signals
  return rights;
}
#endif

}  // namespace

void drop_privileges() {
  // Capabilities of the bounding set need CAP_SETPCAP, so they go before the user does.
  become_nobody();
  drop_capabilities();
  const rlimit no_process{0, 0};
  setrlimit(RLIMIT_NPROC, &no_process);
#if defined(__linux__)
  prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);  // a change of the user resets it
#endif
}

bool hide_files() {
#if defined(SUNDER_HAS_LANDLOCK)
  const long version =
      syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return false;
  const Rights rights = rights_of(version);
  // A newer kernel accepts the shorter structure, and an older one a longer one only with zeros.
  const int rules =
      static_cast<int>(syscall(SYS_landlock_create_ruleset, &rights, sizeof rights, 0));
  if (rules < 0) return false;
  const bool is_hidden = syscall(SYS_landlock_restrict_self, rules, 0) == 0;
  close(rules);
  return is_hidden;
#else
  return false;
#endif
}

}  // namespace sunder::import_helper
