#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "bindings/c/handles.h"

namespace sunder::c {

struct BytesObject : Object {
  static constexpr Kind kKind = Kind::bytes;
  std::vector<std::byte> bytes;
};

sunder_status add_bytes(std::vector<std::byte> bytes, sunder_bytes* handle);
/// With a zero at its end.
sunder_status add_text(std::string_view text, sunder_bytes* handle);

}  // namespace sunder::c
