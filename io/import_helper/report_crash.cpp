#include "io/import_helper/report_crash.h"

#include <csignal>
#include <sys/socket.h>
#include <unistd.h>

#include "io/import_messages/messages.h"

namespace sunder::import_helper {
namespace {

volatile std::sig_atomic_t may_report = 1;

/// The stack may be exhausted.
alignas(16) char signal_stack[16'384];

extern "C" void on_crash(int signal) { report_failure(static_cast<unsigned>(signal)); }

}  // namespace

void report_crashes() {
  stack_t stack{};
  stack.ss_sp = signal_stack;
  stack.ss_size = sizeof signal_stack;
  sigaltstack(&stack, nullptr);
  struct sigaction action = {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK | static_cast<int>(SA_RESETHAND);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU})
    sigaction(signal, &action, nullptr);
}

void stop_reporting() { may_report = 0; }

void report_failure(unsigned long long cause) {
  if (may_report != 0) {
    may_report = 0;
    const import_messages::Request request{.kind = import_messages::RequestKind::failed,
                                           .first = cause};
    send(import_messages::kSocket, &request, sizeof request, MSG_NOSIGNAL);
  }
  _exit(1);
}

}  // namespace sunder::import_helper
