#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>

#include "io/assimp/asset_files.h"
#include "io/assimp/glb_builder.h"
#include "io/assimp/notes.h"

namespace sunder::assimp_import {

/// Writes materials when primitives first request them. Images are copied without decoding.
class MaterialWriter {
 public:
  MaterialWriter(const aiScene& scene, AssetFiles& folder, GlbBuilder& glb, Notes& notes)
      : scene_(scene), folder_(folder), glb_(glb), notes_(notes) {}

  /// glTF's index of an assimp material for a primitive with these texture coordinates. If the
  /// primitive lacks coordinates that a texture needs, it gets a copy of the material without the
  /// texture. kNone if the material does not exist.
  [[nodiscard]] std::optional<std::uint32_t> material_for(
      std::uint32_t material, std::span<const std::uint32_t> texcoord_of_channel);

 private:
  struct Texture {
    std::uint32_t index = kNone;  ///< kNone: no usable texture.
    std::uint32_t channel = 0;    ///< Index of the texture coordinates in assimp.
  };
  const Texture& base_texture(std::uint32_t material);
  std::uint32_t texture_of(const std::string& path, int wrap_u, int wrap_v);
  std::uint32_t image_of(const std::string& path);
  Json describe(std::uint32_t material);

  const aiScene& scene_;
  AssetFiles& folder_;
  GlbBuilder& glb_;
  Notes& notes_;
  std::map<std::uint32_t, Texture> texture_of_material_;
  std::map<std::string, std::uint32_t> image_of_path_;
  /// By material and TEXCOORD number; kNone: without texture.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> written_;
};

}  // namespace sunder::assimp_import
