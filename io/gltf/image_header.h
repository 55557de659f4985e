#pragma once

#include <cstddef>
#include <span>

namespace sunder::gltf {

/// The media type of image bytes, if glTF or one of its extensions supports it; otherwise null.
[[nodiscard]] const char* image_type(std::span<const std::byte> bytes);

/// Whether the part of a PNG or JPEG that gives its size and kind of pixels is there and plausible.
/// Other images are not looked into.
[[nodiscard]] bool is_image_header_sound(std::span<const std::byte> bytes);

}  // namespace sunder::gltf
