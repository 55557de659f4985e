#include "io/contained_import/run_helper.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <new>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "io/contained_import/conversation.h"
#include "io/contained_import/find_helper.h"
#include "io/contained_import/helper_process.h"
#include "io/contained_import/memory_limit.h"
#include "io/import_messages/reply.h"

namespace sunder::contained_import {
namespace {

using namespace import_messages;
using assimp_import::ImportedGlb;
using assimp_import::ModelFile;

bool requires_filter(const LoadOptions& options) {
  return options.strict || options.requires_filter;
}

/// An import keeps its scene while it makes the GLB from it, so the GLB of one that was not taken
/// over has at most half of the memory that the import may use.
std::uint64_t maximum_reply(std::uint64_t bytes, const LoadOptions& options) {
  return std::min(options.maximum_bytes, import_memory_of(bytes, options) / 2);
}

Job job_of(const ModelFile& model, const LoadOptions& options) {
  const double seconds = std::ceil(std::min(options.import_seconds, 1e8));
  return {.name_bytes = static_cast<std::uint32_t>(model.name.size()),
          .model_bytes = model.file.bytes,
          .maximum_bytes = options.maximum_bytes,
          .memory = can_raise_memory_limit() ? import_memory_of(model.file.bytes, options)
                                             : options.import_memory,
          .largest_memory = options.import_memory,
          .cpu_seconds = static_cast<std::uint32_t>(seconds) + 1,
          .caller = static_cast<std::int32_t>(getpid()),
          .strict = options.strict ? 1u : 0u,
          .requires_filter = requires_filter(options) ? 1u : 0u};
}

const char* name_of_signal(int signal) {
  switch (signal) {
    case SIGSEGV: return "SIGSEGV, invalid memory access or stack overflow";
    case SIGBUS: return "SIGBUS, invalid memory access";
    case SIGABRT: return "SIGABRT, failed assertion or damaged memory";
    case SIGFPE: return "SIGFPE, invalid arithmetic";
    case SIGILL: return "SIGILL, invalid instruction";
    case SIGSYS: return "SIGSYS, a system call that imports may not make";
    default: return nullptr;
  }
}

Status timed_out(const ModelFile& model, const LoadOptions& options) {
  return Status::failure(StatusCode::limit_exceeded, kNone,
                         "%.100s: not imported within %g seconds (LoadOptions::import_seconds)",
                         model.name.c_str(), options.import_seconds);
}

Status out_of_memory(const ModelFile& model, std::uint64_t memory) {
  return Status::failure(StatusCode::limit_exceeded, kNone,
                         "%.100s: the importer ran out of its %llu MiB of memory "
                         "(LoadOptions::import_memory)",
                         model.name.c_str(), static_cast<unsigned long long>(memory >> 20));
}

Status stopped_by(int signal, const ModelFile& model, const LoadOptions& options) {
  if (signal == SIGXCPU) return timed_out(model, options);
  if (signal == SIGKILL)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%.100s: the system killed the importer; it is probably short of memory",
                           model.name.c_str());
  if (const char* const name = name_of_signal(signal))
    return Status::failure(StatusCode::malformed_file, kNone, "%.100s: the importer crashed (%s)",
                           model.name.c_str(), name);
  return Status::failure(StatusCode::malformed_file, kNone,
                         "%.100s: the importer crashed (signal %d)", model.name.c_str(), signal);
}

Status too_large(const ModelFile& model, std::uint64_t bytes, const LoadOptions& options) {
  const std::uint64_t most = maximum_reply(bytes, options);
  return Status::failure(StatusCode::limit_exceeded, kNone,
                         "%.100s: more than %llu bytes after import (LoadOptions::%s)",
                         model.name.c_str(), static_cast<unsigned long long>(most),
                         most == options.maximum_bytes ? "maximum_bytes" : "import_memory");
}

Status unfiltered(const ModelFile& model, const Conversation& conversation,
                  const LoadOptions& options) {
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "%.100s: not imported, because the helper process cannot filter its "
                         "system calls: %s (LoadOptions::%s)",
                         model.name.c_str(), conversation.ready.why_not.data(),
                         options.requires_filter ? "requires_filter" : "strict");
}

/// @param status  from wait, or -1.
/// @param bytes   of all files that the helper could read.
Status failure_of(const Conversation& conversation, int status, std::uint64_t bytes,
                  const ModelFile& model, const LoadOptions& options) {
  switch (conversation.outcome) {
    case Outcome::timed_out: return timed_out(model, options);
    case Outcome::too_large: return too_large(model, bytes, options);
    case Outcome::unfiltered: return unfiltered(model, conversation, options);
    case Outcome::insatiable:
      return Status::failure(StatusCode::limit_exceeded, kNone,
                             "%.100s: the importer asked for other files more than %llu times",
                             model.name.c_str(), static_cast<unsigned long long>(kMostRequests));
    case Outcome::failed:
      if (conversation.cause == kOutOfMemory)
        return out_of_memory(model, import_memory_of(bytes, options));
      if (conversation.cause < kOutOfMemory)
        return stopped_by(static_cast<int>(conversation.cause), model, options);
      break;
    case Outcome::wrong_helper:
    case Outcome::ended:
    case Outcome::replied: break;
  }
  if (status != -1 && WIFSIGNALED(status)) return stopped_by(WTERMSIG(status), model, options);
  return Status::failure(StatusCode::malformed_file, kNone,
                         "%.100s: the importer ended without a result", model.name.c_str());
}

Status wrong_helper(const std::filesystem::path& helper, int status) {
  return Status::failure(StatusCode::file_unreadable, kNone,
                         "'%.120s' is not a sunder-import of this version, or lacks a library "
                         "(it ended with %d)",
                         helper.c_str(),
                         status != -1 && WIFEXITED(status) ? WEXITSTATUS(status) : status);
}

/// The helper's report is trusted as little as its GLB, but that it runs without a filter is known
/// from before it read the model.
Result<ImportedGlb> imported_from(Conversation& conversation, std::uint64_t memory,
                                  const ModelFile& model) {
  Result<LoadReport> report = decode_head(conversation.head, model.name);
  if (!report) return report.error();
  if (conversation.ready.has_filter == 0)
    report->notes.push_back(
        {LoadNote::Kind::warning, "import",
         std::string("the helper process ran without a filter of system calls: ") +
             conversation.ready.why_not.data(),
         1});
  return ImportedGlb{std::move(conversation.body), std::move(*report), memory};
}

}  // namespace

Result<ImportedGlb> run_helper(const ModelFile& model, files::AllowedFiles& allowed,
                               const LoadOptions& options) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(std::min(options.import_seconds, 1e8)));
  const Result<OwnProgram> helper = find_helper(options.import_helper);
  if (!helper) return helper.error();
  Result<HelperProcess> process = HelperProcess::start(*helper, deadline);
  if (!process) return process.error();

  std::uint64_t bytes = model.file.bytes;
  const auto file_opened = [&](std::uint64_t more) {
    const std::uint64_t before = import_memory_of(bytes, options);
    bytes += more;
    raise_memory_limit(process->id(), import_memory_of(bytes, options) - before);
  };
  Socket& socket = process->socket();
  const Job job = job_of(model, options);
  // If these fail, the helper has ended. It may have told the cause before, without waiting for all
  // of the job, so what it sent is read in any case.
  if (socket.send_value(job, model.file.descriptor.value()) == Transfer::complete)
    (void)socket.send(std::as_bytes(std::span(model.name)));
  Conversation conversation =
      serve(socket, allowed,
            {requires_filter(options), [&] { return maximum_reply(bytes, options); }, file_opened});
  const bool must_stop =
      conversation.outcome == Outcome::timed_out || conversation.outcome == Outcome::too_large ||
      conversation.outcome == Outcome::insatiable || conversation.outcome == Outcome::unfiltered;
  // A process that closed the socket in order to run on is killed soon.
  const auto patience = std::chrono::milliseconds(must_stop ? 0 : 500);
  const int status = process->finish(Clock::now() + patience);
  if (conversation.outcome == Outcome::replied)
    return imported_from(conversation, import_memory_of(bytes, options), model);
  if (conversation.outcome == Outcome::wrong_helper) return wrong_helper(helper->path, status);
  return failure_of(conversation, status, bytes, model, options);
}

}  // namespace sunder::contained_import
