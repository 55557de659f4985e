// A GLB or glTF text from memory: read, written and read again.

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

namespace {

void require(bool holds, const char* law, const sunder::Status& status) {
  if (holds) return;
  std::fprintf(stderr, "%s: %.*s\n", law, static_cast<int>(status.text().size()),
               status.text().data());
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  const auto* const begin = reinterpret_cast<const std::byte*>(data);
  ReadOptions options;
  options.maximum_bytes = 1 << 20;
  const auto loaded = load_glb({begin, begin + size}, options);
  if (!loaded) {
    require(loaded.error().code() != StatusCode::internal_error, "reading fails inside",
            loaded.error());
    return 0;
  }
  const Status valid = validate_character(*loaded->character);
  require(valid.is_ok(), "what was read is not valid", valid);
  const auto written = save_glb(*loaded->character, *loaded);
  if (!written && written.error().code() == StatusCode::limit_exceeded) return 0;
  require(written.has_value(), "what was read cannot be written", written.error());
  ReadOptions again = options;
  again.maximum_bytes = std::uint64_t{64} << 20;
  const auto reloaded = load_glb(*written, again);
  require(reloaded.has_value(), "what was written cannot be read", reloaded.error());
  require(reloaded->character->meshes.size() == loaded->character->meshes.size(),
          "a mesh was lost or added", {});
  return 0;
}
