#pragma once

#include <sunder/core/index.h>

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "tools/messages/visible.h"

namespace sunder::tools {

using Json = nlohmann::ordered_json;

/// An index; null for kNone.
[[nodiscard]] inline Json index_json(std::uint32_t index) {
  return index == kNone ? Json() : Json(index);
}

/// The numbers of a vector of 2, 3 or 4.
template <class Vector>
[[nodiscard]] Json vector_json(const Vector& vector) {
  Json array = Json::array();
  for (int i = 0; i < Vector::RowsAtCompileTime; ++i)
    array.push_back(static_cast<double>(vector[i]));
  return array;
}

/// UTF-8 text, indented by two spaces, with an end of line. Bytes of names that are not UTF-8 are
/// replaced, and controls beyond ASCII are escaped, so that a terminal can show it.
[[nodiscard]] inline std::string dump(const Json& json) {
  return visible_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) + '\n';
}

/// The same without white space and end of line.
[[nodiscard]] inline std::string dump_line(const Json& json) {
  return visible_json(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace sunder::tools
