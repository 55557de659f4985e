#pragma once

#include <sunder/core/mesh.h>
#include <sunder/io/character_file.h>

#include <filesystem>
#include <string>
#include <vector>

namespace sunder {

/// A scene without bones, for a renderer. Model space, metres.
struct StillScene {
  /// Triangles of one colour that no light changes.
  struct Mark {
    std::string name;
    Vec4f color = Vec4f::Ones();  ///< Linear RGBA; blended if alpha is below 1.
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
  };
  /// A light that is infinitely far away.
  struct Light {
    Vec3d towards = Vec3d::UnitZ();  ///< From the scene to the light; any length except zero.
    double intensity = 1;            ///< 3 lights a surface that faces it about fully.
  };

  std::vector<Mesh> surfaces;  ///< Posed; skins and morph targets are ignored.
  std::vector<Mark> marks;
  std::vector<Light> lights;
};

/// Writes a scene as GLB. Submesh::material of the surfaces is an index in `materials`; submeshes
/// without one, or all if there is no document, get a plain light grey one. Of a material its base
/// colour, alpha and emission are kept: without surroundings to mirror, metal would be black.
///
/// @return the number of materials that lose a texture, because its image is missing or neither PNG
///         nor JPEG; index_out_of_range for an unknown material; file_unreadable.
[[nodiscard]] SUNDER_API Result<std::uint32_t> save_still(const std::filesystem::path& file,
                                                          const StillScene& scene,
                                                          const SourceDocument* materials);

}  // namespace sunder
