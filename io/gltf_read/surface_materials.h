#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf/source_document.h"
#include "io/internal/base_colours.h"

namespace sunder::gltf {

/// A texture of a material, and where it lies.
struct SurfaceTexture {
  std::uint32_t image = kNone;  ///< In SurfaceMaterials::images; kNone without one.
  std::uint32_t uv_set = 0;
  /// KHR_texture_transform: where in the image a place (u, v, 1) of the texture coordinates is.
  Eigen::Matrix<float, 2, 3> image_from_uv = Eigen::Matrix<float, 2, 3>::Identity();
  BaseColour::Wrap wrap_u = BaseColour::Wrap::repeat, wrap_v = BaseColour::Wrap::repeat;

  bool operator==(const SurfaceTexture&) const = default;
};

/// A material of core glTF: metallic and rough, with its textures, as the file says.
struct SurfaceMaterial {
  std::string name;
  Vec4f base_colour = Vec4f::Ones();  ///< Linear RGBA; times the texture.
  float metallic = 1, roughness = 1;  ///< Times blue and green of their texture.
  Vec3f emission = Vec3f::Zero();     ///< Linear RGB; times the texture.
  float normal_scale = 1;             ///< Of x and y of the normal map.
  float occlusion_strength = 1;
  SurfaceTexture base_texture, metallic_roughness_texture, normal_texture, occlusion_texture,
      emission_texture;
  enum class Alpha : std::uint8_t { opaque, mask, blend };
  Alpha alpha = Alpha::opaque;
  float cutoff = 0.5f;  ///< With Alpha::mask.
  bool is_double_sided = false;
};

struct SurfaceMaterials {
  std::vector<SurfaceMaterial> materials;  ///< One per entry of /materials.
  std::vector<BaseColours::Image> images;
  std::uint32_t left_out =
      0;  ///< Images that are missing, of an unknown kind, or beyond the limit.
};

/// Reads all materials of a document; what is missing or malformed has its default.
/// @param maximum_bytes  limit for all images together.
[[nodiscard]] SurfaceMaterials read_surface_materials(const SourceDocument& source,
                                                      std::uint64_t maximum_bytes);

}  // namespace sunder::gltf
