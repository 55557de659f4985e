#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "io/gltf/decoders.h"

namespace sunder::gltf {

/// The parts of a glTF file, as views into its content.
struct Container {
  bool is_glb = false;
  std::string_view json;
  std::span<const std::byte> binary;  ///< The BIN chunk of a GLB; empty if there is none.
};

[[nodiscard]] bool has_glb_magic(std::span<const std::byte> content);

/// Finds the JSON and the BIN chunk. Every declared length is checked against the content.
[[nodiscard]] Container split_container(std::span<const std::byte> content);

/// Whether a GLB that split_container() accepted follows every rule of its format: exact and
/// aligned lengths, one chunk of JSON and at most one of binary data.
[[nodiscard]] bool is_container_sound(std::span<const std::byte> glb);

/// Parses the JSON after checking its nesting and its size in memory; then checks its version and
/// required extensions.
/// @param maximum_memory  for the parsed document, bytes.
[[nodiscard]] Json parse_document(std::string_view text, std::uint64_t maximum_memory,
                                  const Decoders& decoders);

}  // namespace sunder::gltf
