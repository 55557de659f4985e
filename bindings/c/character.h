#pragma once

#include <sunder/io/character_bytes.h>

#include <memory>
#include <vector>

#include "bindings/c/handles.h"

namespace sunder::c {

/// A mesh as C sees it: pointers into a Mesh, and the tables that hold them.
class MeshView {
 public:
  /// @param mesh  outlives the view, unchanged. Allocates where a mesh has more of something than
  ///              any before.
  void set(const Mesh& mesh);
  [[nodiscard]] const sunder_mesh& get() const { return view_; }

 private:
  sunder_mesh view_ = {};
  std::vector<const float*> uv_sets_, color_sets_;
  std::vector<sunder_attribute> attributes_;
  std::vector<sunder_morph_target> morph_targets_;
  std::vector<sunder_submesh> submeshes_;
};

/// The tables of sunder_get_character().
struct CharacterView {
  explicit CharacterView(const Character& character);

  sunder_character_data data = {};
  std::vector<sunder_bone> bones;
  std::vector<sunder_skin> skins;
  std::vector<MeshView> mesh_views;
  std::vector<sunder_mesh> meshes;
  std::vector<std::vector<sunder_channel>> channels;  ///< Per clip.
  std::vector<sunder_clip> clips;
};

/// A character with the document that it came from; `loaded.source` is null without one. Immutable.
struct CharacterParts {
  /// @param of_source  what the document holds; null: `of.character`.
  explicit CharacterParts(LoadedCharacter of, std::shared_ptr<const Character> of_source = nullptr);

  /// The bytes of a GLB of this character, or of one that was torn from it.
  [[nodiscard]] Result<std::vector<std::byte>> save(const Character& character,
                                                    const SaveOptions& options) const;

  LoadedCharacter loaded;
  /// Differs from `loaded.character` where that was changed after it was loaded: saving compares
  /// with it to find what must be written.
  std::shared_ptr<const Character> in_source;
  CharacterView view;
  std::vector<sunder_note> notes;
};

struct CharacterObject : Object {
  static constexpr Kind kKind = Kind::character;
  std::shared_ptr<const CharacterParts> parts;
};

/// @param in_source  what `loaded.source` holds; null: `loaded.character`.
sunder_status add_character(LoadedCharacter loaded, sunder_character* handle,
                            std::shared_ptr<const Character> in_source = nullptr);

/// A character from arrays, not validated yet.
/// @return a failure for null arrays and enumerators.
[[nodiscard]] Result<Character> copy_character(const sunder_character_data& data);

[[nodiscard]] SaveOptions save_options_of(const sunder_save_options* options);

/// sunder_transform and BoneTransform.
[[nodiscard]] sunder_transform transform_of(const BoneTransform& transform);
[[nodiscard]] BoneTransform transform_of(const sunder_transform& transform);

}  // namespace sunder::c
