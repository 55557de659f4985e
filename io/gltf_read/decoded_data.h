#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "io/gltf/cursor.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// Takes the decoded form of compressed data into a document, as further buffers. The bytes share
/// one limit: LoadOptions::maximum_bytes, and 16 MiB plus 1024 times the file. Meshes that the
/// codecs were made for shrink to a tenth or a hundredth.
class DecodedData {
 public:
  explicit DecodedData(SourceDocument& document);

  /// Bytes that may still be decoded.
  [[nodiscard]] std::uint64_t bytes_left() const { return bytes_left_; }

  struct Buffer {
    std::uint32_t index = 0;  ///< In /buffers.
    std::span<std::byte> bytes;
  };
  /// Appends a buffer of zeros.
  /// @param claims  the claimant, for the error text.
  [[nodiscard]] Buffer add_buffer(std::uint64_t size, const Cursor& claims);

  /// Appends a buffer view of a whole buffer. @return its index.
  std::uint32_t add_view(const Buffer& buffer);

 private:
  SourceDocument& document_;
  std::uint64_t bytes_left_ = 0;
};

/// Removes a name from the lists of extensions of a document.
void unlist_extension(Json& document, const char* name);

/// Forgets the content of buffers that no buffer view refers to any more.
void drop_unused_buffers(SourceDocument& document);

}  // namespace sunder::gltf
