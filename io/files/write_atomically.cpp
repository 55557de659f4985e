#include "io/files/write_atomically.h"

#include <atomic>
#include <cstdio>
#include <system_error>

namespace sunder {

Status write_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  static std::atomic<unsigned> counter{0};
  const auto failure = [&] {
    return Status::failure(StatusCode::file_unreadable, kNone, "'%.150s' cannot be written",
                           file.filename().c_str());
  };
  // "x" neither follows nor overwrites an existing file, so two writers never use the same file.
  std::filesystem::path beside;
  std::FILE* stream = nullptr;
  for (int attempt = 0; attempt < 100 && stream == nullptr; ++attempt) {
    beside = file;
    beside += ".part" + std::to_string(counter++);
    stream = std::fopen(beside.c_str(), "wbx");
  }
  if (stream == nullptr) return failure();
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  const bool closed = std::fclose(stream) == 0;
  std::error_code error;
  if (written && closed) {
    std::filesystem::rename(beside, file, error);
    if (!error) return {};
  }
  std::filesystem::remove(beside, error);
  return failure();
}

}  // namespace sunder
