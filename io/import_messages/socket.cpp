#include "io/import_messages/socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <utility>

namespace sunder::import_messages {
namespace {

/// Space for one descriptor, aligned as the kernel wants it.
union ControlBuffer {
  cmsghdr header;
  char bytes[CMSG_SPACE(sizeof(int))];
};

msghdr message_of(iovec& part) {
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  return message;
}

void attach(msghdr& message, ControlBuffer& control, int descriptor) {
  std::memset(&control, 0, sizeof control);
  message.msg_control = control.bytes;
  message.msg_controllen = sizeof control.bytes;
  cmsghdr* const header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof descriptor);
  std::memcpy(CMSG_DATA(header), &descriptor, sizeof descriptor);
}

files::Descriptor attached(msghdr& message) {
  const cmsghdr* const header = CMSG_FIRSTHDR(&message);
  if (header == nullptr || header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_RIGHTS ||
      header->cmsg_len != CMSG_LEN(sizeof(int)))
    return {};
  int descriptor = -1;
  std::memcpy(&descriptor, CMSG_DATA(header), sizeof descriptor);
  return files::Descriptor(descriptor);
}

}  // namespace

int milliseconds_until(Clock::time_point deadline) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000));
}

Socket::Socket(files::Descriptor descriptor, std::optional<Clock::time_point> deadline)
    : descriptor_(std::move(descriptor)), deadline_(deadline) {}

bool Socket::is_late() const { return deadline_ && Clock::now() >= *deadline_; }

Transfer Socket::wait(short events) const {
  for (;;) {
    if (is_late()) return Transfer::timed_out;
    pollfd waiting{descriptor_.value(), events, 0};
    const int ready = poll(&waiting, 1, deadline_ ? milliseconds_until(*deadline_) + 1 : -1);
    if (ready > 0) return Transfer::complete;
    if (ready < 0 && errno != EINTR) return Transfer::ended;
  }
}

Transfer Socket::send(std::span<const std::byte> bytes, int descriptor) {
  while (!bytes.empty()) {
    iovec part{const_cast<std::byte*>(bytes.data()), bytes.size()};
    msghdr message = message_of(part);
    ControlBuffer control;
    if (descriptor >= 0) attach(message, control, descriptor);
    const int flags = MSG_NOSIGNAL | (deadline_ ? MSG_DONTWAIT : 0);
    const ssize_t sent = sendmsg(descriptor_.value(), &message, flags);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
      descriptor = -1;
    } else if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      if (const Transfer waited = wait(POLLOUT); waited != Transfer::complete) return waited;
    } else if (sent == 0 || errno != EINTR) {
      return Transfer::ended;
    }
  }
  return Transfer::complete;
}

Transfer Socket::receive(std::span<std::byte> bytes, files::Descriptor* descriptor) {
  while (!bytes.empty()) {
    if (is_late()) return Transfer::timed_out;  // also if the bytes are there
    iovec part{bytes.data(), bytes.size()};
    msghdr message = message_of(part);
    ControlBuffer control;
    if (descriptor != nullptr) {
      message.msg_control = control.bytes;
      message.msg_controllen = sizeof control.bytes;
    }
    const int flags = MSG_CMSG_CLOEXEC | (deadline_ ? MSG_DONTWAIT : 0);
    const ssize_t got = recvmsg(descriptor_.value(), &message, flags);
    if (got > 0) {
      if (descriptor != nullptr && message.msg_controllen > 0) *descriptor = attached(message);
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    } else if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      if (const Transfer waited = wait(POLLIN); waited != Transfer::complete) return waited;
    } else if (got == 0 || errno != EINTR) {
      return Transfer::ended;
    }
  }
  return Transfer::complete;
}

}  // namespace sunder::import_messages
