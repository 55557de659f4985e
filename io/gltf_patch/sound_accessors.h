#pragma once

#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/accessors.h"

namespace sunder::gltf {

/// Checks whether accessors of a document follow the rules of glTF for what they are used as. It
/// keeps no data but answers, so that an accessor is decoded once however often it is used. Decoded
/// data is limited all the same, because any number of accessors may lie on the same bytes.
class SoundAccessors {
 public:
  /// @param document  follows enforce_schema().
  explicit SoundAccessors(SourceDocument& document);

  /// The accessor, if its elements lie in their view and are aligned; otherwise nothing.
  [[nodiscard]] std::optional<Accessor> open(const Json& index);
  /// Its numbers; nothing if one is not finite.
  [[nodiscard]] std::optional<std::vector<float>> floats(const Accessor& accessor);
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> integers(const Accessor& accessor);
  [[nodiscard]] bool is_finite(const Accessor& accessor);
  /// The greatest number of one component; nothing if the numbers cannot be read.
  [[nodiscard]] std::optional<double> greatest(const Accessor& accessor);

  enum class Rule : std::uint8_t { times, rotations, spline_rotations, normals, tangents, shares };
  /// Whether all numbers are finite and pass `check`, which is asked once per accessor and rule.
  template <class Check>
  [[nodiscard]] bool follows(Rule rule, const Accessor& accessor, const Check& check) {
    const auto [known, is_new] = answers_.try_emplace({accessor.index, rule}, false);
    if (is_new) {
      const auto numbers = floats(accessor);
      known->second = numbers && check(*numbers);
    }
    return known->second;
  }

  /// Vertex attributes must begin, and follow each other, at multiples of four bytes.
  [[nodiscard]] bool is_aligned_for_vertices(const Accessor& accessor) const;
  /// Everything but vertex attributes must be packed.
  [[nodiscard]] bool has_stride(const Accessor& accessor) const;
  [[nodiscard]] std::string_view type(const Accessor& accessor) const;

  /// Sets `min` and `max` to the least and greatest values, if they are there or required.
  void correct_bounds(std::uint32_t index, bool required);

 private:
  /// The range of the numbers as they are stored, before normalised integers become floats.
  struct Survey {
    bool is_finite = false;  ///< Also: they could be read.
    std::vector<double> least, greatest;
  };

  [[nodiscard]] std::optional<Accessor> open_new(const Json& index);
  [[nodiscard]] const Survey& survey(const Accessor& accessor);
  [[nodiscard]] bool is_aligned(const Json& accessor) const;
  [[nodiscard]] bool is_sparse_sound(const Json& accessor, const Accessor& opened);

  SourceDocument& document_;
  AccessorReader reader_;
  std::map<std::uint64_t, std::optional<Accessor>> opened_;
  std::map<std::uint32_t, Survey> surveys_;
  std::map<std::pair<std::uint32_t, Rule>, bool> answers_;
};

}  // namespace sunder::gltf
