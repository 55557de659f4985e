#pragma once

#include <sunder/core/character.h>
#include <sunder/core/vertex_origins.h>
#include <sunder/weights/influences.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// The file from which a character was loaded, kept so that saving can patch it. Opaque.
class SourceDocument;

/// One kind of thing that loading repaired, dropped or reports, counted over the file.
struct LoadNote {
  enum class Kind : std::uint8_t {
    information,
    repaired,
    dropped,
    warning,  ///< The model is as in the file, but it was read with less protection than usual.
  };
  Kind kind = Kind::information;
  std::string place;        ///< "mesh 2 'Body'", "clip 'Walk'".
  std::string text;         ///< "weights did not sum to one and were normalised".
  std::uint32_t count = 1;  ///< Number of vertices, keys … concerned.
};

struct LoadReport {
  std::string format;  ///< "glTF 2.0 binary", "FBX by assimp".
  std::string space;   ///< Space and unit of the model: "metres, y up, as in the file".
  std::vector<LoadNote> notes;
};

/// How a model is read.
struct ReadOptions {
  /// Refuses what would otherwise be repaired or dropped.
  bool strict = false;
  /// Limit for the file together with all files that it refers to.
  std::uint64_t maximum_bytes = std::uint64_t{2} << 30;
  /// Limit for the memory that reading takes, because a small file can describe a large model. 0:
  /// 20 times the size of the file and all files that it refers to, but at least 64 MiB.
  std::uint64_t maximum_memory = 0;
  /// Fills LoadedCharacter::stored, for validation. glTF and GLB only.
  bool keep_stored_influences = false;
};

struct LoadedCharacter {
  std::shared_ptr<const Character> character;    ///< Satisfies validate_character().
  std::shared_ptr<const SourceDocument> source;  ///< For save_glb().
  LoadReport report;
  /// One per mesh, with ReadOptions::keep_stored_influences; empty for formats other than glTF.
  std::vector<StoredInfluences> stored;
};

/// Gives the other files to which a model refers by relative URIs.
class FileResolver {
 public:
  virtual ~FileResolver() = default;

  /// Thread-safe. Is asked for buffers when a model is read, and for images when it is read and
  /// when it is written. Throws nothing but std::bad_alloc.
  /// @param uri  as it stands in the model, percent codes included.
  /// @return the bytes of the file, or a failure if there is none.
  [[nodiscard]] virtual Result<std::vector<std::byte>> read(std::string_view uri) const = 0;
};

/// Reads a GLB, or glTF text, from memory, as load_character() reads a file. Nothing but the bytes
/// and what the resolver gives is read. Thread-safe.
/// @param bytes     kept as the source document.
/// @param resolver  kept as well; null: the model may refer to no other file.
/// @return as load_character(); path_not_allowed for a reference without a resolver; the failure of
///         the resolver.
[[nodiscard]] SUNDER_API Result<LoadedCharacter> load_glb(
    std::vector<std::byte> bytes, const ReadOptions& options = {},
    std::shared_ptr<const FileResolver> resolver = nullptr);

/// SaveOptions::maximum_influences that writes all.
inline constexpr std::uint32_t kAllInfluences = kNone;

/// A material without textures.
struct AppendedMaterial {
  std::string name;
  Vec4f base_colour = Vec4f::Ones();  ///< Linear RGBA, each 0 to 1.
  float metallic = 0.0f;              ///< 0 to 1.
  float roughness = 1.0f;             ///< 0 to 1.
  bool double_sided = false;

  bool operator==(const AppendedMaterial&) const = default;
};

/// A material of the source document whose base colour is another image: a copy that is written
/// beside it, with its other textures, samplers and extensions.
struct PaintedMaterial {
  /// Where in the image texture coordinates are: at offset + scale * (u, v).
  struct Placement {
    Vec2f offset = Vec2f::Zero(), scale = Vec2f::Ones();
  };
  std::uint32_t source = kNone;  ///< In the source document; kNone: glTF's default material.
  std::vector<std::byte> image;  ///< PNG, sRGB. The factor of the base colour is part of it.
  std::uint32_t uv_set = 0;      ///< Texture coordinates of the image.
  /// Empty: as the source places its own image (KHR_texture_transform).
  std::optional<Placement> placement = {};
};

/// How the influences of the meshes that are written are stored. Meshes that stay as they are in
/// the source document keep theirs.
struct SaveOptions {
  /// Largest number of influences per vertex, 4 or 8; the largest are kept and renormalised.
  /// kAllInfluences writes all, in as many JOINTS_n and WEIGHTS_n as needed. 0 writes no
  /// more than the vertex of the source that has the most, over all meshes, and at least four.
  std::uint32_t maximum_influences = 0;
  WeightFormat weights = WeightFormat::float32;
  /// One per mesh of the character, in place of `weights`; empty: `weights` for all.
  std::vector<WeightFormat> weights_of_mesh = {};
  /// Materials that Submesh::material counts after those of the source document. Only to save what
  /// was loaded.
  std::vector<AppendedMaterial> materials = {};
  /// Materials that Submesh::material counts after `materials`. GLB only, and only to save what was
  /// loaded.
  std::vector<PaintedMaterial> painted = {};
  /// One per mesh of the character, for a file that explains itself (docs/torn_file.md); empty: no
  /// record. Only to save what was loaded. Further vertices of a mesh have no origin.
  std::vector<MeshOrigins> origins = {};
  /// With `origins`: the weights that are written were chosen by a certificate, which bounds how
  /// far they move a vertex in every pose, metres.
  std::optional<double> certified_bound = {};
  /// With `origins`: how far appended vertices leave the places between their parents in every
  /// pose, metres, if it was certified.
  std::optional<double> place_bound = {};
};

/// The influences of a mesh that save_glb() writes.
struct WrittenInfluences {
  std::uint32_t mesh = 0;             ///< In Character::meshes.
  std::uint32_t maximum = 0;          ///< Per vertex, by SaveOptions; 0: all.
  std::uint32_t most = 0;             ///< Of the vertex with the most, as written.
  std::uint64_t vertices_pruned = 0;  ///< Vertices that have more than the maximum.
  /// Largest share of a vertex's weight that is left out, in [0, 1).
  double dropped_mass_max = 0.0;
};

/// Predicts how save_glb() with the same arguments changes influences: one entry per mesh that it
/// would write and that has any, ascending. Nothing is written. How far a vertex moves by it in a
/// pose: pruning_displacement().
/// @return as save_glb(). O(influences), allocates.
[[nodiscard]] SUNDER_API Result<std::vector<WrittenInfluences>> written_influences(
    const Character& character, const LoadedCharacter& loaded, const SaveOptions& options = {});

/// The bytes of the file that save_glb() of <sunder/io/character_file.h> writes. @return as it.
[[nodiscard]] SUNDER_API Result<std::vector<std::byte>> save_glb(const Character& character,
                                                                 const LoadedCharacter& loaded,
                                                                 const SaveOptions& options = {});

/// The same for a character that was not loaded. @return as that call.
[[nodiscard]] SUNDER_API Result<std::vector<std::byte>> save_glb(const Character& character,
                                                                 const SaveOptions& options = {});

}  // namespace sunder
