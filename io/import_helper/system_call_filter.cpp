#include <cerrno>
#include <cstdio>
#include <cstring>
#include <unistd.h>

#include "io/import_helper/sandbox.h"
#include "io/import_helper/under_sanitizer.h"
#include "io/import_messages/messages.h"

// Sanitizers make system calls of their own.
#if SUNDER_HAS_SECCOMP && !defined(SUNDER_UNDER_SANITIZER)
#define SUNDER_FILTERS 1
#endif

#if SUNDER_FILTERS
#include <seccomp.h>
#include <sys/mman.h>
#endif

namespace sunder::import_helper {

#if SUNDER_FILTERS

namespace {

constexpr int kAllowed[] = {
    // Descriptors that the caller opened.
    SCMP_SYS(read), SCMP_SYS(pread64), SCMP_SYS(lseek), SCMP_SYS(_llseek), SCMP_SYS(close),
    // Memory. Mapping is below.
    SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise), SCMP_SYS(futex),
    // Time and random numbers.
    SCMP_SYS(clock_gettime), SCMP_SYS(clock_gettime64), SCMP_SYS(gettimeofday), SCMP_SYS(time),
    SCMP_SYS(getrandom), SCMP_SYS(sched_yield),
    // Signals of this process, and its end.
    SCMP_SYS(rt_sigreturn), SCMP_SYS(sigreturn), SCMP_SYS(rt_sigprocmask), SCMP_SYS(sigprocmask),
    SCMP_SYS(rt_sigaction), SCMP_SYS(sigaction), SCMP_SYS(sigaltstack), SCMP_SYS(getpid),
    SCMP_SYS(gettid), SCMP_SYS(restart_syscall), SCMP_SYS(exit), SCMP_SYS(exit_group)};

constexpr int kFatal[] = {SCMP_SYS(execve),
                          SCMP_SYS(execveat),
                          SCMP_SYS(fork),
                          SCMP_SYS(vfork),
                          SCMP_SYS(clone),
                          SCMP_SYS(clone3),
                          SCMP_SYS(ptrace),
                          SCMP_SYS(socket),
                          SCMP_SYS(process_vm_readv),
                          SCMP_SYS(process_vm_writev)};

constexpr int kOnSocket[] = {SCMP_SYS(sendmsg), SCMP_SYS(recvmsg), SCMP_SYS(sendto),
                             SCMP_SYS(recvfrom)};

/// Adds rules; a call that this architecture lacks is none.
class Rules {
 public:
  explicit Rules(scmp_filter_ctx filter) : filter_(filter) {}

  template <class... Conditions>
  void add(std::uint32_t action, int call, Conditions... conditions) {
    const int result =
        seccomp_rule_add(filter_, action, call, sizeof...(conditions), conditions...);
    if (result != 0 && result != -EDOM && error_ == 0) error_ = -result;
  }
  [[nodiscard]] int error() const { return error_; }

 private:
  scmp_filter_ctx filter_;
  int error_ = 0;
};

int add_rules(scmp_filter_ctx filter) {
  Rules rules(filter);
  for (const int call : kAllowed) rules.add(SCMP_ACT_ALLOW, call);
  for (const int call : kFatal) rules.add(SCMP_ACT_KILL_PROCESS, call);
  // Not by SCMP_CMP(), which is C.
  const scmp_arg_cmp on_socket{0, SCMP_CMP_EQ, import_messages::kSocket, 0};
  for (const int call : kOnSocket) rules.add(SCMP_ACT_ALLOW, call, on_socket);
  // Memory that is not executable.
  const scmp_arg_cmp not_executable{2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0};
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mmap2), SCMP_SYS(mprotect)})
    rules.add(SCMP_ACT_ALLOW, call, not_executable);
  // abort() sends a signal to its own thread.
  const scmp_arg_cmp own{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()), 0};
  rules.add(SCMP_ACT_ALLOW, SCMP_SYS(tgkill), own);
  return rules.error();
}

}  // namespace

NoFilterReason filter_system_calls() {
  NoFilterReason reason{};
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  int error = filter == nullptr ? ENOMEM : add_rules(filter);
  if (error == 0) error = -seccomp_load(filter);
  if (filter != nullptr) seccomp_release(filter);
  if (error != 0)
    std::snprintf(reason.data(), reason.size(), "the system refused the filter: %s",
                  std::strerror(error));
  return reason;
}

#else

NoFilterReason filter_system_calls() {
  NoFilterReason reason{};
  std::snprintf(reason.data(), reason.size(),
                "Sunder was built without libseccomp, or with a sanitizer");
  return reason;
}

#endif

}  // namespace sunder::import_helper
