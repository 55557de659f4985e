#pragma once

#include <sunder/core/index.h>

#include <span>
#include <utility>

#include "io/gltf/glb.h"

namespace sunder::gltf {

/// A JSON array of floats, each as the double of the same value.
inline Json numbers_of(std::span<const float> values) {
  Json array = Json::array();
  for (const float value : values) array.push_back(static_cast<double>(value));
  return array;
}

/// @return the index of the new entry. Makes the list if the document has none.
inline Index append(Json& document, const char* list_name, Json entry) {
  Json& list = list_of(document, list_name);
  list.push_back(std::move(entry));
  return static_cast<Index>(list.size() - 1);
}

}  // namespace sunder::gltf
