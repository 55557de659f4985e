#pragma once

#include <sunder/core/character.h>
#include <sunder/io/character_file.h>

#include <string_view>
#include <vector>

namespace sunder::tools {

/// What a part of a surface is made of, as far as names and materials tell.
enum class SurfaceKind : std::uint8_t {
  skin,     ///< Named as skin or as a part of a body.
  unnamed,  ///< Nothing tells.
  dead,     ///< Cloth, metal, hair or a thing: it has no flesh.
};

/// The kind that a name tells: of its words, which capitals, digits and other characters separate,
/// the last that is known decides: "Body_Armor" is armour, "Glove Skin" is skin.
[[nodiscard]] SurfaceKind kind_of_name(std::string_view name);

/// The kinds of the parts of a model. The name of a material decides before that of its mesh, and a
/// material with a high metallic factor is metal unless its name says skin. Where materials are
/// named as skin, the names of meshes make no others skin.
class SurfaceKinds {
 public:
  /// Knows the names of meshes only.
  explicit SurfaceKinds(const Character& character);
  /// @param source  null: as above.
  /// @return the failures of read_base_colours().
  [[nodiscard]] static Result<SurfaceKinds> create(const Character& character,
                                                   const SourceDocument* source);

  /// @param material  as Submesh::material.
  [[nodiscard]] SurfaceKind of(std::uint32_t mesh, std::uint32_t material) const;
  /// Materials that the source has.
  [[nodiscard]] std::uint32_t material_count() const {
    return static_cast<std::uint32_t>(materials_.size());
  }

 private:
  std::vector<SurfaceKind> meshes_, materials_;
  bool names_skin_ = false;  ///< A material does.
};

}  // namespace sunder::tools
