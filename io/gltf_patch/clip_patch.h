#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <span>

#include "io/gltf/glb.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// Writes clips as animations of a source document.
class ClipPatch {
 public:
  /// @param node_of_bone  per bone; bones without a node, and those behind the last one, are not
  /// animated.
  ClipPatch(GlbDraft& draft, const Character& character, const SourceDocument& source,
            std::span<const std::uint32_t> node_of_bone);

  /// Writes the clips that differ from those of the source in their place, and further ones behind
  /// them. Nodes with a matrix that such a clip animates get a translation, rotation and scale
  /// instead, which glTF demands.
  /// @param before  the character of the source.
  /// @throws Refusal  of a channel whose bone or morph weights the file cannot animate.
  void write_changed(const Character& before);

  /// An animation of those channels whose targets the document still has. Null if there is none.
  /// @param old  the animation that it replaces, whose name and extras it keeps; or null.
  [[nodiscard]] Json animation_of(const Clip& clip, const Json& old);

 private:
  [[nodiscard]] std::uint32_t node_of(const Channel& channel) const;
  [[nodiscard]] std::uint32_t node_of_weights(const Channel& channel) const;
  void prepare_target(const Clip& clip, std::uint32_t index);
  void replace_matrix(const Clip& clip, std::uint32_t channel);

  GlbDraft& draft_;
  const Character& character_;
  const SourceDocument& source_;
  std::span<const std::uint32_t> node_of_bone_;
};

}  // namespace sunder::gltf
