#include "io/files/read_file.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <poll.h>
#include <unistd.h>

#include "io/internal/read_input.h"

namespace sunder {
namespace files {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits until a pipe has data or its last writer has left it. @return false: it is too late.
bool wait_for_data(int descriptor, Clock::time_point deadline) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd wanted{descriptor, POLLIN, 0};
    const int ready = poll(&wanted, 1, static_cast<int>(left.count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

/// Reads up to `count` bytes, at the end of the file fewer. @return -1: it cannot be read.
ssize_t read_some(int descriptor, void* to, std::size_t count) {
  ssize_t read = 0;
  do read = ::read(descriptor, to, count);
  while (read < 0 && errno == EINTR);
  return read;
}

/// Reads to the end. @tparam Bytes  a string or a vector of bytes.
template <class Bytes>
Result<Bytes> read_to_end(const OpenFile& file, std::uint64_t maximum_bytes,
                          Clock::time_point deadline) {
  constexpr std::uint64_t kBlock = std::uint64_t{1} << 18;  // is in the cache when it is read to
  const int descriptor = file.descriptor.value();
  Bytes bytes;
  bytes.reserve(std::min(file.bytes, maximum_bytes) + 1);  // no more is needed to see the end
  for (;;) {
    if (file.is_pipe && !wait_for_data(descriptor, deadline))
      return Status::failure(StatusCode::file_unreadable, kNone,
                             "no end of the pipe came in time; %zu bytes did", bytes.size());
    const std::size_t begin = bytes.size();
    // One byte more than allowed shows that there is more.
    const std::uint64_t wanted = std::min(kBlock - 1, maximum_bytes - begin) + 1;
    const std::size_t room = bytes.capacity() - begin;
    bytes.resize(begin + (room > 0 ? std::min<std::uint64_t>(wanted, room) : wanted));
    const ssize_t count = read_some(descriptor, &bytes[begin], bytes.size() - begin);
    bytes.resize(begin + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count == 0) return bytes;
    if (count < 0 && !(file.is_pipe && errno == EAGAIN))
      return Status::failure(StatusCode::file_unreadable, kNone, "cannot be read to its end");
    if (bytes.size() > maximum_bytes)
      return Status::failure(StatusCode::limit_exceeded, kNone,
                             "more than %llu bytes, which are the limit",
                             static_cast<unsigned long long>(maximum_bytes));
  }
}

}  // namespace

Result<std::vector<std::byte>> read_all(const OpenFile& file, std::uint64_t maximum_bytes) {
  return read_to_end<std::vector<std::byte>>(file, maximum_bytes, {});
}

std::string read_head(const std::filesystem::path& file, std::size_t most) {
  const Result<OpenFile> opened = open_regular_file(file);
  if (!opened) return {};
  std::string head(most, '\0');
  std::size_t size = 0;
  while (size < most) {
    const ssize_t count = read_some(opened->descriptor.value(), &head[size], most - size);
    if (count <= 0) break;
    size += static_cast<std::size_t>(count);
  }
  head.resize(size);
  return head;
}

}  // namespace files

Result<std::string> read_input(const std::filesystem::path& file, std::uint64_t maximum_bytes,
                               std::chrono::milliseconds patience) {
  const auto deadline = files::Clock::now() + patience;
  const Result<files::OpenFile> opened = files::open_file_or_pipe(file);
  if (!opened) return opened.error();
  const std::string name = file.filename().string();
  if (opened->bytes > maximum_bytes)
    return Status::failure(StatusCode::limit_exceeded, kNone, "%s: %llu bytes; the limit is %llu",
                           name.c_str(), static_cast<unsigned long long>(opened->bytes),
                           static_cast<unsigned long long>(maximum_bytes));
  Result<std::string> text = files::read_to_end<std::string>(*opened, maximum_bytes, deadline);
  if (text) return text;
  return Status::failure(text.error().code(), kNone, "%s: %s", name.c_str(),
                         std::string(text.error().text()).c_str());
}

}  // namespace sunder
