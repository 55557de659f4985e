#pragma once

#include <sunder/core/math.h>
#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sunder {

/// How a material colours a surface without light, for viewers, and what it is made of.
struct BaseColour {
  enum class Wrap : std::uint8_t { repeat, clamp, mirror };

  std::string name;
  /// The metallic factor, where the file gives one and no texture varies it; 0 otherwise, although
  /// glTF's default is 1: many files leave it out.
  float metallic = 0;
  Vec4f factor = Vec4f::Ones();  ///< Linear RGBA.
  std::uint32_t image = kNone;   ///< In BaseColours::images; multiplied by `factor`.
  std::uint32_t uv_set = 0;      ///< Texture coordinates of the images.
  /// KHR_texture_transform: where in the images a place (u, v, 1) of the texture coordinates is.
  Eigen::Matrix<float, 2, 3> image_from_uv = Eigen::Matrix<float, 2, 3>::Identity();
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool is_pixelated = false;             ///< Magnified images show their pixels as squares.
  float cutoff = 0;                      ///< Nothing is drawn where the image's alpha is below.
  bool is_blended = false;               ///< Alpha mixes the surface with what is behind it.
  bool is_unlit = false;                 ///< KHR_materials_unlit.
  Vec3f emission = Vec3f::Zero();        ///< Linear RGB, KHR_materials_emissive_strength included.
  std::uint32_t emission_image = kNone;  ///< In BaseColours::images; multiplied by `emission`.
  bool lacks_image = false;              ///< The file names one that is left out.
};

/// The base colours of a file's materials, with their images as in the file.
struct BaseColours {
  struct Image {
    std::string type;  ///< "image/png", "image/jpeg" or "image/webp".
    std::vector<std::byte> bytes;
  };
  std::vector<BaseColour> materials;  ///< Submesh::material is an index into them.
  std::vector<Image> images;          ///< Each once, however many entries of the file are it.
  std::uint32_t left_out = 0;  ///< Images that are missing, of another kind, or beyond the limit.
};

/// The limit for the images of what is drawn or shown, all together, in bytes.
inline constexpr std::uint64_t kMostImageBytes = std::uint64_t{256} << 20;

/// Reads what a loaded file says of its materials; what is missing or malformed has its default.
/// Images are read as saving reads them: from the file or its own folder.
/// @param maximum_bytes  limit for all images together.
/// @return limit_exceeded: out of memory.
[[nodiscard]] SUNDER_API Result<BaseColours> read_base_colours(const SourceDocument& source,
                                                               std::uint64_t maximum_bytes);

}  // namespace sunder
