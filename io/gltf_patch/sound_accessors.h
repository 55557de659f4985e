#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "io/gltf/accessors.h"

namespace sunder::gltf {

/// Checks whether accessors of a document follow the rules of glTF for what they are used as. It
/// keeps no data; every question about values decodes the accessor.
class SoundAccessors {
 public:
  /// @param document  follows enforce_schema().
  explicit SoundAccessors(SourceDocument& document);

  /// The accessor, if its elements lie in their view and are aligned; otherwise nothing.
  [[nodiscard]] std::optional<Accessor> open(const Json& index);
  /// Its numbers; nothing if one is not finite.
  [[nodiscard]] std::optional<std::vector<float>> floats(const Accessor& accessor);
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> integers(const Accessor& accessor);

  /// Vertex attributes must begin, and follow each other, at multiples of four bytes.
  [[nodiscard]] bool is_aligned_for_vertices(const Accessor& accessor) const;
  /// Everything but vertex attributes must be packed.
  [[nodiscard]] bool has_stride(const Accessor& accessor) const;
  [[nodiscard]] std::string_view type(const Accessor& accessor) const;

  /// Sets `min` and `max` to the least and greatest values, if they are there or required.
  void correct_bounds(std::uint32_t index, bool required);

 private:
  [[nodiscard]] bool is_aligned(const Json& accessor) const;
  [[nodiscard]] bool is_sparse_sound(const Json& accessor, const Accessor& opened);

  SourceDocument& document_;
  AccessorReader reader_;
};

}  // namespace sunder::gltf
