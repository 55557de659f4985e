#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "io/gltf/cursor.h"

namespace sunder {
class SourceDocument;
}

namespace sunder::gltf {

class DecodedData;
class Notes;

struct JsonLimits {
  std::size_t levels = 0;   ///< Of nested arrays and objects.
  std::size_t members = 0;  ///< Of one object.
  /// Bytes of the parsed document, about: its text, 32 per comma, 80 per array and object.
  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max();
};

/// What third parties decode. A program that has none of them reads GLB without it: by nlohmann's
/// parser, and without compression. io/gltf_decoders/ has all.
struct Decoders {
  /// Parses well-formed JSON faster than nlohmann's parser, with the same result.
  /// @return nothing for all that exceeds a limit, is malformed, or is rare enough to be left to
  /// nlohmann's parser, such as an object that names a member twice.
  std::optional<Json> (*json)(std::string_view text, const JsonLimits& limits) = nullptr;
  /// Decodes the buffer views that EXT_meshopt_compression or KHR_meshopt_compression compress:
  /// the document becomes one without that extension, whose views have the decoded bytes. Saving
  /// writes these. Compressed data counts where a file has both.
  /// @return the views whose data a filter rounded.
  std::vector<std::uint32_t> (*meshopt_views)(SourceDocument& document, DecodedData& decoded,
                                              Notes& notes) = nullptr;
  /// Decodes the primitives that KHR_draco_mesh_compression compresses: the document becomes one
  /// without that extension, whose accessors have the decoded data. Saving writes these. Primitives
  /// that have their data uncompressed too only lose the extension. The document's buffer views
  /// must have been checked.
  void (*draco_primitives)(SourceDocument& document, DecodedData& decoded, Notes& notes) = nullptr;
};

}  // namespace sunder::gltf
