// Reads the reply of the helper process, as a model that has taken the process over could send it:
// four bytes for the length of the head, the head, the GLB.

#include <sunder/io/character_bytes.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "io/import_messages/reply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::uint32_t head_bytes = 0;
  if (size < sizeof head_bytes) return 0;
  std::memcpy(&head_bytes, data, sizeof head_bytes);
  const std::span<const std::uint8_t> rest(data + sizeof head_bytes, size - sizeof head_bytes);
  const std::size_t length = std::min<std::size_t>(head_bytes, rest.size());
  const std::string_view head(reinterpret_cast<const char*>(rest.data()), length);
  if (!sunder::import_messages::decode_head(head, "fuzz.fbx")) return 0;
  const auto glb = std::as_bytes(rest.subspan(length));
  (void)sunder::load_glb({glb.begin(), glb.end()});
  return 0;
}
