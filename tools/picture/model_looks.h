#pragma once

#include <sunder/core/character.h>
#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>

#include <span>
#include <string>
#include <vector>

#include "io/internal/base_colours.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// The materials of a model for drawing: base colours and emission with their textures, PNG and
/// JPEG. Each image is decoded once; those beyond a limit are left out.
class ModelLooks {
 public:
  /// @param source       null: a model without a file has no materials.
  /// @param most_pixels  of all images together.
  /// @return the failures of read_base_colours().
  [[nodiscard]] static Result<ModelLooks> create(const SourceDocument* source,
                                                 std::uint64_t most_pixels = kMostImagePixels);

  /// Says how many materials are drawn without a texture that their file names; empty if none is.
  [[nodiscard]] std::string missing_textures() const;

  /// A material of the file for those who lay something on it.
  struct OfFile {
    BaseColour colour;         ///< Its images are not those of `material`.
    RenderMaterial material;   ///< Refers to images of this object.
    bool lacks_image = false;  ///< The file names one that is not drawn.
  };
  /// @param material  as Submesh::material; white without texture if the file has none.
  [[nodiscard]] OfFile of_file(std::uint32_t material) const;

  /// The colour of what has no material.
  [[nodiscard]] const Vec4f& plain_color() const { return materials_[kPlain].factor; }

  /// A scene without triangles that has these materials; it must not outlive this object.
  [[nodiscard]] RenderScene begin_scene() const;

  /// What a submesh is drawn with in place of its material.
  struct Cover {
    std::uint32_t material = kNone;  ///< In the scene; kNone: its own.
    std::uint32_t uv_set = 0;
    Eigen::Matrix<float, 2, 3> image_from_uv = Eigen::Matrix<float, 2, 3>::Identity();
  };
  /// How add_mesh() takes the parts of a mesh.
  struct Flesh {
    std::uint32_t first_submesh = kNone;  ///< From this one on they are walls and caps: flesh.
    float unit = 1;                       ///< Size of its features, metres.
    /// Per triangle: whether its inside is flesh too; null: of none.
    const std::vector<bool>* inside = nullptr;
    /// Per submesh of the source: what it is drawn with in place of its material; empty: none is.
    std::span<const Cover> covers = {};
    float reaches = 1;  ///< BloodPlace::rest per metre in bind space.
  };
  /// Adds the surface of a mesh to a scene that began here.
  /// @param posed  of the mesh, with normals.
  void add_mesh(const Mesh& mesh, const DeformedMesh& posed, const Flesh& flesh,
                RenderScene& scene) const;

  /// The material of flesh in scenes that begin here.
  static constexpr std::uint32_t kFlesh = 0;

 private:
  static constexpr std::uint32_t kPlain = 1, kFirst = 2;
  /// @param lacks_image  set if one could not be decoded.
  [[nodiscard]] RenderMaterial material_of(const BaseColour& colour, bool& lacks_image) const;

  std::vector<Image> images_;
  std::vector<RenderMaterial> materials_;  ///< Flesh, a plain one, those of the file.
  std::vector<BaseColour> colours_;        ///< Per material, for its texture coordinates.
  std::vector<bool> lack_images_;          ///< Per material.
  std::uint64_t most_pixels_ = 0;
};

}  // namespace sunder::tools
