// An operation log: read, written and read again.

#include <sunder/io/operation_log.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", law);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto aimed = parse_aimed_operations(text);
  require(aimed || aimed.error().code() != StatusCode::internal_error, "reading fails inside");
  const auto operations = parse_operations(text);
  if (!operations) {
    require(operations.error().code() != StatusCode::internal_error, "reading fails inside");
    return 0;
  }
  require(aimed.has_value(), "plain operations are no aimed ones");
  const auto written = format_operations(*operations);
  require(written.has_value(), "what was read cannot be written");
  const auto again = parse_operations(*written);
  require(again.has_value(), "what was written cannot be read");
  require(*format_operations(*again) == *written, "the second text differs");
  return 0;
}
