#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// A list of a JSON object; added if it is absent.
Json& list_of(Json& object, const char* name);

/// A document that will be written as GLB: its JSON, and one BIN chunk. The chunk only grows until
/// remove_bytes() is called, so existing indices stay valid.
class GlbDraft {
 public:
  /// Copies the document and joins all its buffers into one.
  explicit GlbDraft(const SourceDocument& source);

  Json json;

  enum class ViewTarget : std::uint16_t { none = 0, vertices = 34962, indices = 34963 };

  /// Appends bytes as a new buffer view. @return its index.
  /// @param stride  bytes from one element to the next if they are not packed; otherwise 0.
  std::uint32_t add_view(std::span<const std::byte> bytes, ViewTarget target,
                         std::uint32_t stride = 0);

  /// The bytes of a buffer view, until the next one is added; none for an index, buffer or range
  /// that does not exist.
  [[nodiscard]] std::span<const std::byte> bytes_of_view(const Json& index) const;

  /// Embeds the images of the source's folder. Images that cannot be read, or whose kind glTF does
  /// not support, keep their URI.
  void embed_images();

  /// A part of the BIN chunk.
  struct Gap {
    std::uint64_t begin = 0, length = 0;
  };
  /// Removes parts of the BIN chunk, which are sorted and do not overlap. Buffer views are not
  /// corrected. Without a byte left, the document has no buffer.
  void remove_bytes(std::span<const Gap> gaps);

  /// The bytes of the BIN chunk so far.
  [[nodiscard]] std::span<const std::byte> bytes() const { return binary_; }

  /// The finished file.
  [[nodiscard]] std::vector<std::byte> finish();

 private:
  std::uint64_t append(std::span<const std::byte> bytes);
  void merge_buffers();
  /// A view with an image; without a type: none.
  struct EmbeddedImage {
    const char* type = nullptr;
    std::uint32_t view = 0;
  };
  EmbeddedImage embed_image(const std::string& uri, std::uint64_t& bytes_left);

  const SourceDocument& source_;
  std::vector<std::byte> binary_;
};

}  // namespace sunder::gltf
