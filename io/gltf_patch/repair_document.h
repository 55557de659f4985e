#pragma once

#include <sunder/io/character_bytes.h>

#include <cstdint>
#include <vector>

#include "io/gltf/glb.h"
#include "io/gltf/source_document.h"

namespace sunder::gltf {

/// How many nodes use each mesh of a document that follows the schema.
[[nodiscard]] std::vector<std::uint32_t> uses_of_meshes(const Json& document);

/// Repairs the draft of a source document so that the written file has no error, whatever the
/// source was: the parts that the character was made from are written anew from the character, the
/// others are corrected or removed. A draft without faults stays as it is.
class DocumentRepair {
 public:
  /// @param character  what will be written; its clips begin with those of the source, in which
  /// single ones may have been changed.
  DocumentRepair(GlbDraft& draft, const Character& character, const SourceDocument& source);

  /// To be called before meshes are written. Afterwards the document follows the schema, but for
  /// primitives that are null because they cannot be kept.
  /// @param are_new  one flag per mesh of the character: it is written in any case. Primitives of
  ///   which nothing is kept are not checked.
  /// @return one flag per mesh of the character: its primitives have faults, so it must be written.
  [[nodiscard]] std::vector<bool> prepare(const std::vector<bool>& are_new);

  /// To be called after meshes were written.
  void finish();

 private:
  [[nodiscard]] std::vector<std::uint32_t> least_joints();
  void check_primitives(const std::vector<bool>* are_new, std::vector<bool>& unsound_meshes);
  void repair_binds();
  void repair_animations();
  void remove_empty_animations();
  void empty_unsound_accessors();

  GlbDraft& draft_;
  const Character& character_;
  const SourceDocument& source_;
  bool has_unsound_primitives_ = false;
};

}  // namespace sunder::gltf
