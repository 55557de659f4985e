#pragma once

#include <array>
#include <optional>

#include "io/gltf/cursor.h"

namespace sunder::gltf {

inline constexpr std::array<const char*, 2> kMeshoptNames = {"EXT_meshopt_compression",
                                                             "KHR_meshopt_compression"};

/// The object of EXT_meshopt_compression or KHR_meshopt_compression in a buffer or buffer view.
[[nodiscard]] std::optional<Cursor> meshopt_extension_of(const Cursor& object);

/// Whether a buffer of /buffers is only a place holder for the decoded data of compressed buffer
/// views. It has no bytes.
[[nodiscard]] bool is_fallback_buffer(const Cursor& buffer);

}  // namespace sunder::gltf
