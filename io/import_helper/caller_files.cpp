#include "io/import_helper/caller_files.h"

#include <string>
#include <unistd.h>
#include <utility>

#include "io/import_messages/messages.h"

namespace sunder::import_helper {
namespace {

using namespace import_messages;

/// Without the caller there is nobody to report to.
void require(Transfer transfer) {
  if (transfer != Transfer::complete) _exit(1);
}

Result<files::OpenFile> ask(Socket& socket, RequestKind kind, std::string_view reference) {
  if (reference.size() > kMostReferenceBytes)
    return Status::failure(StatusCode::file_not_found, kNone, "a reference of %zu bytes",
                           reference.size());
  require(socket.send_value(Request{.kind = kind, .first = reference.size()}));
  require(socket.send(std::as_bytes(std::span(reference))));
  Answer answer;
  files::OpenFile file;
  require(socket.receive_value(answer, &file.descriptor));
  std::string text(answer.text_bytes, '\0');
  require(socket.receive(std::as_writable_bytes(std::span(text))));
  if (answer.code != static_cast<std::uint32_t>(StatusCode::ok))
    return Status::failure(static_cast<StatusCode>(answer.code), kNone, "%s", text.c_str());
  file.bytes = answer.bytes;
  return file;
}

}  // namespace

Status CallerFiles::look_up(std::string_view reference) {
  return request(RequestKind::look_up, reference).error();
}

Result<files::OpenFile> CallerFiles::open(std::string_view reference) {
  return request(RequestKind::open, reference);
}

Result<files::OpenFile> CallerFiles::request(RequestKind kind, std::string_view reference) {
  if (const auto known = refused_.find(reference); known != refused_.end()) return known->second;
  Result<files::OpenFile> file = ask(socket_, kind, reference);
  if (!file) refused_.emplace(reference, file.error());
  return file;
}

}  // namespace sunder::import_helper
