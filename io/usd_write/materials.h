#pragma once

#include <sunder/core/character.h>
#include <sunder/io/character_bytes.h>
#include <sunder/io/usd_file.h>

#include <string>
#include <vector>

#include "io/gltf_read/surface_materials.h"
#include "io/usd_write/usd_text.h"

namespace sunder::usd {

/// The materials of a layer: those of a document and the appended ones, as far as submeshes name
/// them, as UsdPreviewSurface.
class Materials {
 public:
  /// @param source  null: none.
  /// @param scope   path of the prim below which they are written.
  /// @throws gltf::Refusal  for a submesh that names another one.
  Materials(const Character& character, const SourceDocument* source, const SaveOptions& options,
            std::string scope, std::string textures_folder);

  /// The path of a submesh's material; empty if it has none.
  [[nodiscard]] std::string path_of(const Submesh& submesh) const;
  [[nodiscard]] bool is_double_sided(const Submesh& submesh) const;

  /// Writes the scope with all of them; nothing if there are none.
  void write(UsdText& text);

  /// The images that write() named, and the number of those that it would have.
  [[nodiscard]] std::vector<UsdLayer::Texture> take_textures();
  [[nodiscard]] std::uint32_t left_out_images() const { return left_out_; }

 private:
  using Texture = gltf::SurfaceTexture;
  using Material = gltf::SurfaceMaterial;

  void add_appended(const std::vector<AppendedMaterial>& appended);
  void name_used(const Character& character, bool has_source);
  /// A number by which what a texture holds is multiplied, and one that is added; and how it is
  /// stored.
  struct Reading {
    Vec4f scale = Vec4f::Ones(), bias = Vec4f::Zero();
    bool is_colour = false;
  };
  [[nodiscard]] bool has_image(const Texture& texture) const;
  /// Whether the colours of vertices stand for the material's own, which is white and without an
  /// image: UsdPreviewSurface cannot multiply two.
  [[nodiscard]] bool shows_vertex_colours(std::size_t material) const;
  void write_material(UsdText& text, std::size_t index);
  void write_surface(UsdText& text, std::size_t index, const std::string& path) const;
  static void write_vertex_colour(UsdText& text);
  void write_alpha(UsdText& text, const Material& material, const std::string& path) const;
  void write_texture(UsdText& text, const std::string& material_path, const char* kind,
                     const Texture& texture, const Reading& reading);
  void write_coordinates(UsdText& text, const std::string& material_path, const char* kind,
                         const Texture& texture) const;

  std::vector<Material> materials_;
  std::vector<BaseColours::Image> images_;
  std::vector<std::string> names_;        ///< Per material; empty for those that nothing uses.
  std::vector<bool> has_vertex_colours_;  ///< Per material: a mesh that uses it has some.
  std::vector<std::string> file_of_;      ///< Per image; empty for those that USD does not know.
  std::vector<bool> is_image_written_;    ///< Per image.
  std::string scope_;
  std::uint32_t left_out_ = 0;
  bool is_any_used_ = false;
};

}  // namespace sunder::usd
