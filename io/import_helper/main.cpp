// sunder-import: reads one model by assimp, in a process of its own with limits, for the Sunder
// library. Not for use by hand.

#include <csignal>
#include <cstdlib>
#include <exception>
#include <fcntl.h>
#include <new>
#include <string>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "io/assimp/import_scene.h"
#include "io/import_helper/caller_files.h"
#include "io/import_helper/report_crash.h"
#include "io/import_helper/sandbox.h"
#include "io/import_messages/messages.h"
#include "io/import_messages/reply.h"
#include "io/import_messages/socket.h"

namespace sunder::import_helper {
namespace {

using import_messages::Job;
using import_messages::Socket;
using import_messages::Transfer;

struct Work {
  assimp_import::ModelFile model;
  LoadOptions options;
};

/// The caller's other descriptors must not be reachable.
void close_inherited() {
#if defined(__linux__)
  if (close_range(import_messages::kSocket + 1, ~0U, 0) == 0) return;
#endif
  const long last = sysconf(_SC_OPEN_MAX);
  for (long descriptor = import_messages::kSocket + 1; descriptor < (last < 0 ? 1024 : last);
       ++descriptor)
    close(static_cast<int>(descriptor));
}

/// Ends with the caller. A caller that ended before this call is noticed by its number. After a
/// change of the user, because that takes the wish back.
void end_with_caller(const Job& job) {
#if defined(__linux__)
  prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
#endif
  if (getppid() != job.caller) _exit(1);
}

bool receive_job(Socket& socket, Job& job, Work& work) {
  if (socket.receive_value(job, &work.model.file.descriptor) != Transfer::complete ||
      job.protocol != import_messages::kProtocol || !work.model.file.descriptor.is_open())
    return false;
  work.model.name.resize(job.name_bytes);
  work.model.file.bytes = job.model_bytes;
  work.options.maximum_bytes = job.maximum_bytes;
  work.options.strict = job.strict != 0;
  return socket.receive(std::as_writable_bytes(std::span(work.model.name))) == Transfer::complete;
}

/// Nothing of the model has been read before this, so the caller can trust `Ready`.
bool contain(Socket& socket, const Job& job) {
  set_limits(
      {.memory = job.memory, .largest_memory = job.largest_memory, .cpu_seconds = job.cpu_seconds});
  drop_privileges();
  end_with_caller(job);
  hide_files();
  import_messages::Ready ready;
  ready.why_not = filter_system_calls();
  ready.has_filter = ready.why_not[0] == '\0' ? 1 : 0;
  return socket.send_value(ready) == Transfer::complete &&
         (ready.has_filter != 0 || job.requires_filter == 0);
}

void reply(Socket& socket, const Result<assimp_import::ImportedGlb>& imported) {
  const std::string head =
      import_messages::encode_head(imported.error(), imported ? imported->report : LoadReport{});
  const std::size_t bytes = imported ? imported->glb.size() : 0;
  stop_reporting();
  const import_messages::Request begin{
      .kind = import_messages::RequestKind::reply, .first = head.size(), .second = bytes};
  if (socket.send_value(begin) == Transfer::complete &&
      socket.send(std::as_bytes(std::span(head))) == Transfer::complete && bytes > 0)
    (void)socket.send(imported->glb);
}

}  // namespace

[[noreturn]] void run() {
  close_inherited();
  Socket socket{files::Descriptor(import_messages::kSocket)};
  Job job;
  Work work;
  if (!receive_job(socket, job, work)) _exit(1);
  report_crashes();
  std::set_terminate(std::abort);
  // An exception would end in abort() where a destructor allocates.
  std::set_new_handler([] { report_failure(import_messages::kOutOfMemory); });
  if (!contain(socket, job)) _exit(1);
  try {
    CallerFiles assets(socket);
    reply(socket, assimp_import::import_scene(work.model, assets, work.options));
  } catch (const std::bad_alloc&) {
    report_failure(import_messages::kOutOfMemory);
  } catch (...) {
    report_failure(import_messages::kException);
  }
  _exit(0);  // The system frees everything faster than destructors do.
}

}  // namespace sunder::import_helper

int main() { sunder::import_helper::run(); }
