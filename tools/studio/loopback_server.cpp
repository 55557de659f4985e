#include "tools/studio/loopback_server.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <event2/buffer.h>
#include <event2/event.h>
#include <event2/http.h>
#include <memory>
#include <netinet/in.h>
#include <string>
#include <string_view>
#include <sys/socket.h>

namespace sunder::tools {
namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr int kMostHeaderBytes = 16 << 10;
constexpr int kSecondsOfSilence = 60;  // before a connection is closed

/// Calls a function of libevent that frees.
template <auto kFree>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using EventBase = std::unique_ptr<event_base, Freed<event_base_free>>;
using HttpServer = std::unique_ptr<evhttp, Freed<evhttp_free>>;
using SignalEvent = std::unique_ptr<event, Freed<event_free>>;

/// What answers need.
struct Served {
  std::span<const ServedFile> files;
  std::uint16_t port;
};

bool names_this_server(const char* host, std::uint16_t port) {
  if (host == nullptr) return false;
  const std::string_view given = host;
  for (const std::string name : {kLoopback, "localhost"})
    if (given == name + ":" + std::to_string(port) || (port == 80 && given == name)) return true;
  return false;
}

void answer(evhttp_request* request, void* context) {
  const Served& served = *static_cast<const Served*>(context);
  const char* const host = evhttp_find_header(evhttp_request_get_input_headers(request), "Host");
  if (!names_this_server(host, served.port)) return evhttp_send_error(request, 403, "Forbidden");
  // As the request has it: no escape is resolved, and no path of a file system is made of it.
  const char* const path = evhttp_uri_get_path(evhttp_request_get_evhttp_uri(request));
  const auto file = std::find_if(
      served.files.begin(), served.files.end(),
      [path](const ServedFile& candidate) { return path != nullptr && candidate.path == path; });
  if (file == served.files.end()) return evhttp_send_error(request, HTTP_NOTFOUND, "Not Found");
  evkeyvalq* const headers = evhttp_request_get_output_headers(request);
  evhttp_add_header(headers, "Content-Type", file->type.c_str());
  evhttp_add_header(headers, "Cache-Control", "no-store");
  evhttp_add_header(headers, "X-Content-Type-Options", "nosniff");
  // Neither a frame nor an element of another site shows them.
  evhttp_add_header(headers, "X-Frame-Options", "DENY");
  evhttp_add_header(headers, "Cross-Origin-Resource-Policy", "same-origin");
  // The content outlives the server.
  evbuffer_add_reference(evhttp_request_get_output_buffer(request), file->content.data(),
                         file->content.size(), nullptr, nullptr);
  evhttp_send_reply(request, HTTP_OK, "OK", nullptr);
}

void end_loop(evutil_socket_t, short, void* base) {
  event_base_loopbreak(static_cast<event_base*>(base));
}

/// The port of a socket that listens; 0 if it cannot be read.
std::uint16_t port_of(evutil_socket_t listener) {
  sockaddr_in address = {};
  socklen_t size = sizeof address;
  void* const place = &address;
  return getsockname(listener, static_cast<sockaddr*>(place), &size) == 0 ? ntohs(address.sin_port)
                                                                          : std::uint16_t{0};
}

}  // namespace

Status serve_on_loopback(std::span<const ServedFile> files, std::uint16_t port,
                         const std::function<void(const std::string& origin)>& on_ready) {
  std::signal(SIGPIPE, SIG_IGN);  // NOLINT(cert-err33-c)  A browser may leave at any time.
  const EventBase base(event_base_new());
  const HttpServer server(base ? evhttp_new(base.get()) : nullptr);
  if (!server)
    return Status::failure(StatusCode::internal_error, kNone, "the server cannot be started");
  evhttp_set_allowed_methods(server.get(), EVHTTP_REQ_GET);
  evhttp_set_max_headers_size(server.get(), kMostHeaderBytes);
  evhttp_set_max_body_size(server.get(), 0);
  evhttp_set_timeout(server.get(), kSecondsOfSilence);
  errno = 0;
  evhttp_bound_socket* const bound = evhttp_bind_socket_with_handle(server.get(), kLoopback, port);
  if (bound == nullptr)
    return Status::failure(StatusCode::invalid_argument, kNone, "port %u of %s: %s", unsigned{port},
                           kLoopback, std::strerror(errno));
  Served served = {files, port_of(evhttp_bound_socket_get_fd(bound))};
  evhttp_set_gencb(server.get(), answer, &served);

  const SignalEvent interrupted(evsignal_new(base.get(), SIGINT, end_loop, base.get()));
  const SignalEvent terminated(evsignal_new(base.get(), SIGTERM, end_loop, base.get()));
  for (const SignalEvent* const signal : {&interrupted, &terminated})
    if (!*signal || event_add(signal->get(), nullptr) != 0)
      return Status::failure(StatusCode::internal_error, kNone, "the server cannot be ended");
  on_ready("http://" + std::string(kLoopback) + ":" + std::to_string(served.port));
  event_base_dispatch(base.get());
  return {};
}

std::string in_address(const std::string& text) {
  const std::unique_ptr<char, Freed<std::free>> encoded(
      evhttp_uriencode(text.data(), static_cast<ev_ssize_t>(text.size()), 0));
  return encoded ? encoded.get() : std::string();
}

}  // namespace sunder::tools
