// Calls of the C library, made of bytes: any functions with any handles, null pointers and numbers.
// None of them ends the program, and none reports a fault of the library itself.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <span>

#include "c/c_objects.h"
#include "c/random_arguments.h"
#include "c_calls.inc"

namespace {

/// Random numbers made of bytes; all are zero after the last one.
class RandomBytes {
 public:
  explicit RandomBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }
  std::uint32_t index(std::uint32_t count) {
    std::uint32_t number = next();
    if (count > 256) number = number << 8u | next();
    return number % count;
  }

 private:
  std::uint8_t next() {
    if (bytes_.empty()) return 0;
    const std::uint8_t byte = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return byte;
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder::test;
  using Arguments = RandomArguments<RandomBytes>;
  constexpr auto& kAll = Calls<Arguments>::kAll;
  static const sunder::Character model = rich_character();
  static const CArrays arrays(model);

  RandomBytes bytes({data, size});
  Arguments arguments(bytes);
  if (!keep_new_objects(arrays.data, arguments)) std::abort();
  while (!bytes.is_at_end()) {
    const auto& [name, call] = kAll[bytes.index(static_cast<std::uint32_t>(std::size(kAll)))];
    arguments.begin_call();
    const sunder_status status = call(arguments);
    arguments.end_call(status);
    if (status == SUNDER_INTERNAL_ERROR) {
      std::fprintf(stderr, "%s: %s\n", name, sunder_last_error());
      std::abort();
    }
  }
  return 0;
}
