#pragma once

#include <sunder/scene/character_instance.h>
#include <sunder/skinning/skinned_mesh.h>

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/drawing/asset_mesh.h"
#include "scene/drawing/draw_triangles.h"
#include "scene/drawing/range_journal.h"
#include "scene/drawing/torn_tail.h"

namespace sunder::scene {

/// The skinning data of the vertices that tears appended to a mesh.
struct PreparedTail {
  TornTail source;
  SkinnedMesh skinned;

  /// Reads all of a mesh that has appended vertices. @throws std::bad_alloc
  [[nodiscard]] static Result<PreparedTail> create(const AssetMesh& asset, Index source_count,
                                                   const Mesh& mesh,
                                                   const InfluencePositions& exact);
};

/// One mesh of a CharacterInstance: the posed vertices that are drawn. Vertices of the source are
/// skinned by the data of the asset, appended ones by data of the instance.
class InstanceMesh {
 public:
  /// Room for new vertices of a mesh that is torn: memory that grows moves, which costs a frame
  /// much more than the tear.
  static Index room_for_tears(Index vertex_count) { return vertex_count / 16 + 64; }

  /// @param room  number of vertices for which memory is kept, beyond those of the source.
  InstanceMesh(const AssetMesh& asset, Index vertex_count, Index room, bool unit_length)
      : asset_(&asset),
        source_count_(vertex_count),
        room_(room),
        unit_length_(unit_length),
        buffer_(VertexTarget()),
        tail_buffer_(VertexTarget()),
        tail_source_(vertex_count),
        triangles_(asset.order) {}

  /// Notes the changes of a call; update() applies them.
  void note(const MeshChange& change, std::uint64_t epoch) noexcept;
  /// Notes all differences of a torn mesh from its source. @throws std::bad_alloc
  void note_all(const Mesh& source, const Mesh& mesh, std::uint64_t epoch);
  /// Takes the data that update() would make of all changes that were noted. O(1).
  void adopt(PreparedTail&& tail) noexcept;
  void set_target(const VertexTarget& target);

  /// Whether update() has to be called before draw().
  [[nodiscard]] bool needs_update() const { return needs_update_; }
  /// Applies what was noted. @param exact  null for a mesh that was never torn. @throws
  /// std::bad_alloc
  Status update(const Mesh& mesh, const InfluencePositions* exact, std::uint64_t epoch);

  /// The inputs of a draw().
  struct Input {
    const BonePalette& palette;
    const VertexDisplacements* displaced = nullptr;
    const ParallelFor& parallel_for;
    std::uint64_t epoch;
  };
  /// Poses the vertices that changed. @throws std::bad_alloc
  Status draw(const Input& input);
  /// Ends a frame that failed: the next one poses every vertex.
  void forget() noexcept;

  /// Whether normals or tangents are posed.
  [[nodiscard]] bool has_directions() const {
    return target_.normals.data != nullptr || target_.tangents.data != nullptr ||
           (!has_target_ && (asset_->has_normals || asset_->has_tangents));
  }
  /// Empty before the first draw(), and after a change since the last one. @throws std::bad_alloc
  [[nodiscard]] PosedMesh posed(std::uint64_t seen);
  [[nodiscard]] Index drawn_vertices() const { return drawn_vertices_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  /// Vertices that a detachment released, or that its undo returned.
  struct Release {
    bool is_released;
    std::vector<Index> vertices;
  };
  void set_tail(SkinnedMesh&& tail) noexcept;
  Status apply_releases();
  Status set_released(const Release& release, bool is_tail);
  Status update_vertices(const Mesh& mesh, const InfluencePositions* exact);
  Status resize(Index vertex_count);
  Status deform(const Input& input);
  Status deform_part(const Input& input, const SkinnedMesh& skinned, PosedBuffer& buffer,
                     Index first, Index count);
  void list_written(std::uint64_t epoch);
  void list_dirty_vertices(std::uint64_t seen, Index count);

  const AssetMesh* asset_;
  Index source_count_, room_;
  bool unit_length_;
  PosedBuffer buffer_, tail_buffer_;
  TornTail tail_source_;
  std::optional<SkinnedMesh> tail_;  ///< Of the appended vertices.
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec4f> tangents_;
  VertexTarget target_;  ///< Memory of the caller, or that of this object.
  bool has_target_ = false;
  Index vertex_count_ = 0;  ///< As of the last update().
  Index first_changed_ =
      kNone;                  ///< First vertex whose skinning data changed since the last draw().
  bool is_drawn_ = false;     ///< Whether draw() was ever called.
  bool needs_update_ = true;  ///< Whether anything was noted since the last draw().

  std::vector<Release> releases_;   ///< Since the last update(), in order.
  bool has_lost_releases_ = false;  ///< Memory ran out while they were noted.
  DrawTriangles triangles_;
  RangeJournal attributes_;
  std::uint64_t drawn_epoch_ = 0;    ///< Epoch of the last draw() that wrote vertices.
  std::uint64_t before_drawn_ = 0;   ///< Epoch of the one before.
  bool writes_all_ = true;           ///< Whether the next draw() writes every vertex.
  Index drawn_vertices_ = 0;         ///< Written by the last draw().
  std::vector<IndexRange> written_;  ///< By the draw() of drawn_epoch_.
  std::vector<IndexRange> moved_;
  std::vector<IndexRange> dirty_vertices_, dirty_attributes_;  // of the last posed()
  std::vector<TriangleWrite> writes_;
};

}  // namespace sunder::scene
