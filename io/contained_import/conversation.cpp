#include "io/contained_import/conversation.h"

#include <algorithm>
#include <span>

#include "io/import_messages/reply.h"

namespace sunder::contained_import {
namespace {

using namespace import_messages;

/// Reads a container of bytes. It takes address space for the declared size, which was checked, and
/// memory as bytes arrive: a growing container would hold its bytes twice while it moves them.
template <class Container>
Transfer receive_growing(Socket& socket, std::uint64_t bytes, Container& target) {
  constexpr std::uint64_t kStep = std::uint64_t{4} << 20;
  target.reserve(bytes);
  std::uint64_t have = 0;
  while (have < bytes) {
    const std::uint64_t step = std::min(bytes - have, kStep);
    target.resize(have + step);
    const auto part = std::as_writable_bytes(std::span(target)).subspan(have, step);
    if (const Transfer transfer = socket.receive(part); transfer != Transfer::complete)
      return transfer;
    have += step;
  }
  return Transfer::complete;
}

class Server {
 public:
  Server(Socket& socket, files::AllowedFiles& allowed, const ConversationRules& rules)
      : socket_(socket), allowed_(allowed), rules_(rules) {}

  Conversation serve() {
    if (!succeeded(socket_.receive_value(result_.ready), Outcome::wrong_helper)) return result_;
    result_.ready.why_not.back() = '\0';
    if (result_.ready.protocol != kProtocol) {
      result_.outcome = Outcome::wrong_helper;
      return std::move(result_);
    }
    if (rules_.requires_filter && result_.ready.has_filter == 0) {
      result_.outcome = Outcome::unfiltered;
      return std::move(result_);
    }
    for (std::uint64_t requests = 0; requests < kMostRequests; ++requests)
      if (!serve_one()) return std::move(result_);
    result_.outcome = Outcome::insatiable;
    return std::move(result_);
  }

 private:
  bool succeeded(Transfer transfer, Outcome if_ended = Outcome::ended) {
    if (transfer == Transfer::complete) return true;
    result_.outcome = transfer == Transfer::timed_out ? Outcome::timed_out : if_ended;
    return false;
  }

  /// @return whether another request may follow.
  bool serve_one() {
    Request request;
    if (!succeeded(socket_.receive_value(request))) return false;
    result_.outcome = Outcome::ended;
    if (request.protocol != kProtocol) return false;
    switch (request.kind) {
      case RequestKind::look_up:
      case RequestKind::open: return answer(request);
      case RequestKind::reply: receive_reply(request); return false;
      case RequestKind::failed:
        result_.outcome = Outcome::failed;
        result_.cause = request.first;
        return false;
    }
    return false;
  }

  bool answer(const Request& request) {
    if (request.first > kMostReferenceBytes) return false;
    std::string reference(request.first, '\0');
    if (!succeeded(socket_.receive(std::as_writable_bytes(std::span(reference))))) return false;
    const std::uint64_t bytes_left = allowed_.bytes_left();
    Result<files::OpenFile> file = files::OpenFile{};
    if (request.kind == RequestKind::open)
      file = allowed_.open(reference);
    else if (const auto found = allowed_.resolve(reference); !found)
      file = found.error();
    const std::string_view text = file.error().text();
    const Answer answer{.code = static_cast<std::uint32_t>(file.error().code()),
                        .text_bytes = static_cast<std::uint32_t>(text.size()),
                        .bytes = file ? file->bytes : 0};
    const int descriptor = file ? file->descriptor.value() : -1;
    // Not again for a file that it had before: its limits would grow by each request.
    if (const std::uint64_t more = bytes_left - allowed_.bytes_left(); more > 0)
      rules_.file_opened(more);
    return succeeded(socket_.send_value(answer, descriptor)) &&
           succeeded(socket_.send(std::as_bytes(std::span(text))));
  }

  void receive_reply(const Request& request) {
    if (request.first > kMostHeadBytes || request.second > rules_.maximum_reply()) {
      result_.outcome = Outcome::too_large;
      return;
    }
    if (succeeded(receive_growing(socket_, request.first, result_.head)) &&
        succeeded(receive_growing(socket_, request.second, result_.body)))
      result_.outcome = Outcome::replied;
  }

  Socket& socket_;
  files::AllowedFiles& allowed_;
  const ConversationRules& rules_;
  Conversation result_;
};

}  // namespace

Conversation serve(Socket& socket, files::AllowedFiles& allowed, const ConversationRules& rules) {
  return Server(socket, allowed, rules).serve();
}

}  // namespace sunder::contained_import
