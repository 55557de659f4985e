// A GLB or glTF text from memory: read, written and read again.

#include <sunder/io/character_file.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include "io/gltf_patch/write.h"
#include "io/gltf_read/read.h"

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
  LoadOptions options;
  options.maximum_bytes = 1 << 20;
  const auto loaded = gltf::read_character({begin, begin + size}, {}, options);
  if (!loaded) {
    require(loaded.error().code() != StatusCode::internal_error, "reading fails inside",
            loaded.error());
    return 0;
  }
  const Status valid = validate_character(*loaded->character);
  require(valid.is_ok(), "what was read is not valid", valid);
  std::vector<std::byte> written;
  try {
    written = gltf::glb_of(*loaded->character, *loaded, {});
  } catch (const std::bad_alloc&) {
    return 0;
  }
  LoadOptions again = options;
  again.maximum_bytes = std::uint64_t{64} << 20;
  const auto reloaded = gltf::read_character(written, {}, again);
  require(reloaded.has_value(), "what was written cannot be read", reloaded.error());
  require(reloaded->character->meshes.size() == loaded->character->meshes.size(),
          "a mesh was lost or added", {});
  return 0;
}
