#pragma once

#include <sunder/particles/soft_body.h>
#include <sunder/skinning/bone_palette.h>

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

namespace sunder {

namespace scene {
struct AssetData;
}

class CharacterAsset;

/// Options of a soft surface. It is decomposed in the rest pose.
struct SoftTissue {
  DecompositionOptions decomposition;
  /// At least one; all particles start with the first.
  std::vector<SoftMaterial> materials = {SoftMaterial()};
  AuthoredTissue authored;  ///< Fields and perforations; kept.
  SoftBodyOptions body;
  Tension tension;                ///< Pulls the lips of tears apart.
  Vec3d gravity = Vec3d::Zero();  ///< m/s^2, model space.
};

struct CharacterAssetOptions {
  std::optional<SoftTissue> soft;  ///< Empty: the surface follows its bones only.
  /// How new vertices are skinned, if an operation has no options of its own.
  WeightOptions weights;
  /// Whether draw() poses vertices. Without it, a shader does, from the palette of the pose, the
  /// weights and births of appended vertices, and the displacements of particles; PosedMesh has no
  /// positions then.
  bool poses_vertices = true;
  SkinningMethod method = SkinningMethod::linear;
  bool has_normals = true;   ///< Whether normals are posed, if a mesh has them.
  bool has_tangents = true;  ///< Likewise for tangents.
  bool unit_length = false;  ///< Whether they are normalised; see VertexTarget::unit_length.
  /// Optional: a coarser level of detail, with the same bones and morph weights, which a Scene
  /// shows instead where an instance is less than `coarser_below` pixels high.
  std::shared_ptr<const CharacterAsset> coarser;
  double coarser_below = 0.0;
  /// The asset allocates from it; see MemoryScope. Null: from the scope of the calling thread.
  std::pmr::memory_resource* memory = nullptr;
};

/// Triangles of an index buffer that one draw call draws.
struct DrawRange {
  std::uint32_t submesh = 0;  ///< Index in Mesh::submeshes, which names the material.
  std::uint32_t first_triangle = 0, triangle_count = 0;

  bool operator==(const DrawRange&) const = default;
};

/// The data that instances of one character share: the character, its skinning data, the structures
/// that tears start from, and the decomposition of its tissue. Immutable, so any number of
/// instances on any threads may use it. Prepare it on a loading thread.
class SUNDER_API CharacterAsset {
 public:
  /// @param character  satisfies validate_character(); kept.
  /// @return as the create() of TornModel, SkinnedMesh, ParticleSet and SoftBody; size_mismatch or
  ///         not_found if the coarser level has other bones or morph weights.
  /// O(size of the character), allocates. Thread-safe.
  [[nodiscard]] static Result<std::shared_ptr<const CharacterAsset>> create(
      std::shared_ptr<const Character> character, const CharacterAssetOptions& options = {});
  ~CharacterAsset();
  CharacterAsset(const CharacterAsset&) = delete;
  CharacterAsset& operator=(const CharacterAsset&) = delete;

  [[nodiscard]] const std::shared_ptr<const Character>& character() const;
  [[nodiscard]] const CharacterAssetOptions& options() const;

  /// The index buffer of a mesh before any tear: the triangles of the mesh, grouped by submesh. The
  /// index buffer of a torn instance differs from it by PosedMesh::triangle_writes. Indices are
  /// unchecked, here and below.
  [[nodiscard]] std::span<const Triangle> triangles(std::uint32_t mesh) const;
  /// One range per submesh that has triangles.
  [[nodiscard]] std::span<const DrawRange> draw_ranges(std::uint32_t mesh) const;

  /// Memory of all shared structures, without the character.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  friend class CharacterInstance;
  explicit CharacterAsset(std::unique_ptr<const scene::AssetData> data);
  std::unique_ptr<const scene::AssetData> data_;
};

}  // namespace sunder
