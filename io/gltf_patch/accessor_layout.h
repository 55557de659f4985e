#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

// Of documents that follow the schema.

/// A member that is a whole number, or a default.
inline std::uint64_t whole_or(const Json& object, const char* name, std::uint64_t otherwise) {
  const auto found = object.find(name);
  return found == object.end() ? otherwise : found->get<std::uint64_t>();
}

/// @param at  an accessor, or the indices of a sparse one.
inline std::uint64_t component_bytes(const Json& at) {
  const auto type = at["componentType"].get<std::uint64_t>();
  return type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
}

/// Bytes of an element without a stride. Columns of matrices begin at multiples of four bytes.
inline std::uint64_t element_bytes(const Json& accessor) {
  struct Shape {
    std::uint64_t columns, rows;
  };
  static const std::map<std::string, Shape> kShapes = {
      {"SCALAR", {1, 1}}, {"VEC2", {1, 2}}, {"VEC3", {1, 3}}, {"VEC4", {1, 4}},
      {"MAT2", {2, 2}},   {"MAT3", {3, 3}}, {"MAT4", {4, 4}}};
  const auto [columns, rows] = kShapes.at(accessor["type"].get<std::string>());
  const std::uint64_t column = rows * component_bytes(accessor);
  return columns == 1 ? column : columns * ((column + 3) / 4 * 4);
}

}  // namespace sunder::gltf
