#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/gltf_patch/sound_accessors.h"

namespace sunder::gltf {

/// Checks whether primitives of a document follow the rules of glTF, up to every number of their
/// vertices.
class SoundPrimitives {
 public:
  /// @param json  of the document of `accessors`.
  SoundPrimitives(const Json& json, SoundAccessors& accessors);

  /// Also corrects the bounds of its accessors.
  /// @param joint_count  of the smallest skin with which it is used; kNone if there is none.
  [[nodiscard]] bool is_sound(const Json& primitive, std::uint32_t joint_count);

  /// The number of vertices; 0 if it has no positions.
  [[nodiscard]] std::uint32_t vertex_count(const Json& primitive);

 private:
  [[nodiscard]] bool is_attribute_sound(const std::string& semantic, const Accessor& accessor);
  [[nodiscard]] bool are_influences_sound(const Json& attributes, std::uint32_t joint_count);
  [[nodiscard]] bool are_weights_sound(const std::vector<Accessor>& sets);
  [[nodiscard]] bool are_indices_sound(const Json& primitive, std::uint32_t vertex_count);
  [[nodiscard]] bool are_targets_sound(const Json& primitive, std::uint32_t vertex_count);
  [[nodiscard]] bool is_format_allowed(const std::string& semantic, const Accessor& accessor) const;
  [[nodiscard]] bool is_delta_allowed(const std::string& semantic, const Accessor& accessor) const;

  SoundAccessors& accessors_;
  std::map<std::vector<std::uint32_t>, bool> influences_;  ///< By the accessors of all sets.
  bool is_quantized_ = false;
};

}  // namespace sunder::gltf
