#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace sunder::compression {

/// The content of a buffer view as meshoptimizer compresses it, with the sizes that its file
/// claims.
struct MeshoptStream {
  enum class Mode : std::uint8_t { attributes, triangles, indices };
  enum class Filter : std::uint8_t { none, octahedral, quaternion, exponential };

  std::span<const std::byte> bytes;
  std::uint64_t count = 0;   ///< Elements: vertices, keys or indices.
  std::uint64_t stride = 0;  ///< Bytes per element.
  Mode mode = Mode::attributes;
  Filter filter = Filter::none;
};

/// Whether the claimed sizes are possible: strides that the mode and the filter allow, and no more
/// elements than the bytes can encode (64 times their size at most).
[[nodiscard]] Status check_stream(const MeshoptStream& stream);

/// Decodes a stream that check_stream() accepts. The content may be anything; decoded indices may
/// be out of range.
///
/// @param out  count x stride bytes, aligned to 4.
/// @return malformed_file; unsupported_feature for a later version of the codec.
[[nodiscard]] Status decode_stream(const MeshoptStream& stream, std::span<std::byte> out);

}  // namespace sunder::compression
