#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

namespace sunder::test {

using Json = nlohmann::ordered_json;

/// Builds small glTF files in code: change `json` as required, then load.
class GltfBuilder {
 public:
  GltfBuilder();
  /// The parts of a GLB with a BIN chunk, and without its buffer's length.
  static GltfBuilder from_glb(const std::vector<std::byte>& glb);

  Json json;

  /// Appends an accessor with a buffer view of its own. @return its index.
  /// @param type  "SCALAR" … "MAT4".
  template <class T>
  std::size_t add(const std::vector<T>& values, const char* type, bool normalized = false) {
    return add_accessor(values.data(), values.size() * sizeof(T), values.size(),
                        component_type<T>(), type, normalized);
  }
  /// Appends a buffer view only.
  template <class T>
  std::size_t add_view(const std::vector<T>& values) {
    return add_view(values.data(), values.size() * sizeof(T));
  }

  [[nodiscard]] std::vector<std::byte> glb() const;
  /// As text with the buffer in a data: URI.
  [[nodiscard]] std::string text() const;
  /// As text, with the given URI for the buffer.
  [[nodiscard]] std::string text_with_uri(const std::string& uri) const;
  [[nodiscard]] const std::vector<std::byte>& binary() const { return binary_; }

  /// Writes a GLB to a temporary folder and loads it.
  [[nodiscard]] Result<LoadedCharacter> load(const LoadOptions& options = {}) const;

 private:
  template <class T>
  static int component_type() {
    if constexpr (std::is_same_v<T, float>)
      return 5126;
    else if constexpr (sizeof(T) == 1)
      return std::is_signed_v<T> ? 5120 : 5121;
    else if constexpr (sizeof(T) == 2)
      return std::is_signed_v<T> ? 5122 : 5123;
    else
      return 5125;
  }
  std::size_t add_view(const void* data, std::size_t size);
  std::size_t add_accessor(const void* data, std::size_t size, std::size_t numbers,
                           int component_type, const char* type, bool normalized);
  [[nodiscard]] Json with_buffer() const;

  std::vector<std::byte> binary_;
};

/// A strip of 10 vertices and 8 triangles along y, on two joints (nodes 1 and 2, not below node 0);
/// the mesh is node 0. Weights change from joint 0 below to joint 1 above.
GltfBuilder skinned_strip();
/// Attributes of the strip's primitive, and its number of vertices.
Json& strip_attributes(GltfBuilder& builder);
inline constexpr std::size_t kStripVertices = 10;

/// Loads bytes as a file of this name.
Result<LoadedCharacter> load_bytes(const std::string& name, const std::vector<std::byte>& bytes,
                                   const LoadOptions& options = {});
Result<LoadedCharacter> load_text(const std::string& text, const LoadOptions& options = {});

inline LoadOptions strict() {
  LoadOptions options;
  options.strict = true;
  return options;
}

/// Whether the text of some note contains this.
bool has_note(const LoadReport& report, LoadNote::Kind kind, const std::string& text);

}  // namespace sunder::test
