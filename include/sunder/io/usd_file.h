#pragma once

#include <sunder/io/character_bytes.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace sunder {

/// A character as a text of USD (.usda), and the images that its materials name.
struct UsdLayer {
  struct Texture {
    std::string path;  ///< Relative to the text: "torn_textures/image_0_1b2c3d4e.png".
    std::vector<std::byte> bytes;
  };
  std::string text;
  std::vector<Texture> textures;
  /// Images of the source that are left out: missing, of a kind that USD does not know (WebP,
  /// KTX2), or beyond 256 MiB.
  std::uint32_t left_out_images = 0;
};

/// Writes a character as USD with UsdSkel: one SkelRoot with a Skeleton, a Mesh per mesh, blend
/// shapes, a SkelAnimation per clip, materials as UsdPreviewSurface. Metres, y up, as model space.
/// The file is made anew: of the source only the materials and their images are used. The same
/// input gives the same bytes. docs/usd.md lists what is written, and what USD cannot hold.
///
/// @param character        as for save_glb(): a valid character, retired triangles are left out.
/// @param loaded           `source`: the document whose materials the submeshes name, or null;
///                         `character`: for SaveOptions::maximum_influences, or null.
/// @param options          weights are floats: another format is refused.
/// @param textures_folder  begins the paths of the textures; letters, digits, '.', '-', '_'.
/// @return the first fault of `character`; invalid_argument, index_out_of_range (a material that
///         neither the document nor the options have), limit_exceeded. O(size of the output).
[[nodiscard]] SUNDER_API Result<UsdLayer> usd_layer(
    const Character& character, const LoadedCharacter& loaded, const SaveOptions& options = {},
    const std::string& textures_folder = "textures");

/// The layer and its textures as one USDZ package: a ZIP file without compression, its entries at
/// multiples of 64 bytes.
/// @param name  of the layer's entry, "torn.usda".
/// @return limit_exceeded above 4 GiB or 65,535 files.
[[nodiscard]] SUNDER_API Result<std::vector<std::byte>> usdz_package(const UsdLayer& layer,
                                                                     const std::string& name);

/// Writes usd_layer() as the file's extension says: `.usdz` as one package; `.usda` as text, with
/// its textures in a folder of the same name and "_textures" beside it, which is made if a texture
/// is written.
/// @return images that were left out; unsupported_format for another extension; the failures above;
///         file_unreadable (cannot write). A failing call leaves an existing file as it was.
[[nodiscard]] SUNDER_API Result<std::uint32_t> save_usd(const std::filesystem::path& file,
                                                        const Character& character,
                                                        const LoadedCharacter& loaded = {},
                                                        const SaveOptions& options = {});

}  // namespace sunder
