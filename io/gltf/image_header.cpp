#include "io/gltf/image_header.h"

#include <cstdint>
#include <string_view>

namespace sunder::gltf {
namespace {

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t offset) {
  return std::to_integer<std::uint32_t>(bytes[offset]);
}

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t offset, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | byte_at(bytes, offset + i);
  return value;
}

bool is_bit_depth_allowed(std::uint32_t color_type, std::uint32_t depth) {
  const bool is_power = depth == 1 || depth == 2 || depth == 4 || depth == 8 || depth == 16;
  switch (color_type) {
    case 0: return is_power;
    case 3: return is_power && depth != 16;
    case 2:
    case 4:
    case 6: return depth == 8 || depth == 16;
    default: return false;
  }
}

/// The header chunk, and a walk over the chunks up to the pixels.
bool is_png_sound(std::span<const std::byte> bytes) {
  constexpr std::size_t kSignature = 8, kChunk = 12;
  if (bytes.size() < kSignature + kChunk + 13 || big_endian(bytes, kSignature, 4) != 13 ||
      as_text(bytes).substr(kSignature + 4, 4) != "IHDR")
    return false;
  const std::size_t header = kSignature + 8;
  if (big_endian(bytes, header, 4) == 0 || big_endian(bytes, header + 4, 4) == 0 ||
      !is_bit_depth_allowed(byte_at(bytes, header + 9), byte_at(bytes, header + 8)) ||
      byte_at(bytes, header + 10) != 0 || byte_at(bytes, header + 11) != 0 ||
      byte_at(bytes, header + 12) > 1)
    return false;
  for (std::size_t at = kSignature; bytes.size() - at >= kChunk;) {
    if (as_text(bytes).substr(at + 4, 4) == "IDAT") return true;
    const std::size_t length = big_endian(bytes, at, 4);
    if (length > bytes.size() - at - kChunk) return false;
    at += kChunk + length;
  }
  return false;
}

bool is_frame_header(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// A walk over the segments up to the frame header.
bool is_jpeg_sound(std::span<const std::byte> bytes) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (byte_at(bytes, at) != 0xFF) return false;
    const std::uint32_t marker = byte_at(bytes, at + 1);
    if (marker == 0xFF) {  // fill bytes
      ++at;
      continue;
    }
    const std::size_t length = big_endian(bytes, at + 2, 2);
    if (length < 2 || length > bytes.size() - at - 2) return false;
    if (is_frame_header(marker)) return length >= 8 && big_endian(bytes, at + 7, 2) != 0;
    at += 2 + length;
  }
  return false;
}

}  // namespace

const char* image_type(std::span<const std::byte> bytes) {
  const std::string_view text = as_text(bytes);
  if (text.substr(0, 8) == "\x89PNG\r\n\x1A\n") return "image/png";
  if (text.substr(0, 3) == "\xFF\xD8\xFF") return "image/jpeg";
  if (text.substr(0, 4) == "RIFF" && text.size() >= 12 && text.substr(8, 4) == "WEBP")
    return "image/webp";
  if (text.substr(0, 7) == "\xABKTX 20") return "image/ktx2";
  return nullptr;
}

bool is_image_header_sound(std::span<const std::byte> bytes) {
  const char* const type = image_type(bytes);
  if (type == nullptr) return true;
  if (std::string_view(type) == "image/png") return is_png_sound(bytes);
  return std::string_view(type) != "image/jpeg" || is_jpeg_sound(bytes);
}

}  // namespace sunder::gltf
