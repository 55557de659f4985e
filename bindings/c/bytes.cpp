#include "bindings/c/bytes.h"

#include <span>

namespace sunder::c {

sunder_status add_bytes(std::vector<std::byte> bytes, sunder_bytes* handle) {
  auto object = std::make_unique<BytesObject>();
  object->bytes = std::move(bytes);
  object->bytes.push_back(std::byte{0});
  return add(std::move(object), handle);
}

sunder_status add_text(std::string_view text, sunder_bytes* handle) {
  const auto bytes = std::as_bytes(std::span(text));
  return add_bytes({bytes.begin(), bytes.end()}, handle);
}

}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_status sunder_get_bytes(sunder_bytes bytes, const uint8_t** data, uint64_t* size) {
  const BytesObject* const object = find<BytesObject>(bytes);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (data == nullptr) return null_pointer("data");
  *data = reinterpret_cast<const uint8_t*>(object->bytes.data());
  if (size != nullptr) *size = object->bytes.size() - 1;
  return SUNDER_OK;
}

sunder_status sunder_destroy_bytes(sunder_bytes bytes) {
  return destroy_object(bytes, Kind::bytes);
}

}  // extern "C"
