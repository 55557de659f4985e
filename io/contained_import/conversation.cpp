#include "io/contained_import/conversation.h"

#include <algorithm>
#include <span>

#include "io/import_messages/reply.h"

namespace sunder::contained_import {
namespace {

using namespace import_messages;

/// Reads a container of bytes. It grows with the bytes that arrive, not by the declared size.
template <class Container>
Transfer receive_growing(Socket& socket, std::uint64_t bytes, Container& target) {
  constexpr std::uint64_t kFirst = std::uint64_t{4} << 20;
  std::uint64_t have = 0;
  while (have < bytes) {
    const std::uint64_t step = std::min(bytes - have, std::max(kFirst, have));
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
  Server(Socket& socket, files::AllowedFiles& allowed, std::uint64_t maximum_reply,
         const std::function<void(std::uint64_t)>& file_opened)
      : socket_(socket),
        allowed_(allowed),
        maximum_reply_(maximum_reply),
        file_opened_(file_opened) {}

  Conversation serve() {
    if (!succeeded(socket_.receive_value(result_.ready), Outcome::wrong_helper)) return result_;
    result_.ready.why_not.back() = '\0';
    if (result_.ready.protocol != kProtocol) {
      result_.outcome = Outcome::wrong_helper;
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
    if (descriptor >= 0) file_opened_(file->bytes);
    return succeeded(socket_.send_value(answer, descriptor)) &&
           succeeded(socket_.send(std::as_bytes(std::span(text))));
  }

  void receive_reply(const Request& request) {
    if (request.first > kMostHeadBytes || request.second > maximum_reply_) {
      result_.outcome = Outcome::too_large;
      return;
    }
    if (succeeded(receive_growing(socket_, request.first, result_.head)) &&
        succeeded(receive_growing(socket_, request.second, result_.body)))
      result_.outcome = Outcome::replied;
  }

  Socket& socket_;
  files::AllowedFiles& allowed_;
  std::uint64_t maximum_reply_;
  const std::function<void(std::uint64_t)>& file_opened_;
  Conversation result_;
};

}  // namespace

Conversation serve(Socket& socket, files::AllowedFiles& allowed, std::uint64_t maximum_reply,
                   const std::function<void(std::uint64_t)>& file_opened) {
  return Server(socket, allowed, maximum_reply, file_opened).serve();
}

}  // namespace sunder::contained_import
