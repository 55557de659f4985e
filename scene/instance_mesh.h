#pragma once

#include <sunder/scene/character_instance.h>
#include <sunder/skinning/skinned_mesh.h>

#include <span>
#include <utility>
#include <vector>

namespace sunder::scene {

/// Collects the ranges that several operations changed, for the frame that draws them.
class PendingRanges {
 public:
  PendingRanges() { pending_.reserve(1); }

  /// Where memory runs out, one range takes in all of them.
  void add(const IndexRange& range) noexcept;
  void add(const DirtyRanges& ranges) noexcept {
    for (const IndexRange& range : ranges) add(range);
  }
  /// Makes room for publish(). @throws std::bad_alloc
  void prepare() { published_.reserve(pending_.size()); }
  /// Lists the ranges added since the last call, ascending and disjoint, up to `count`. Call
  /// prepare() first.
  void publish(Index count) noexcept;
  [[nodiscard]] std::span<const IndexRange> published() const { return published_; }
  [[nodiscard]] bool has_pending() const { return !pending_.empty(); }

 private:
  std::vector<IndexRange> pending_, published_;
};

/// One mesh of a CharacterInstance: its skinning data, and the posed vertices that are drawn.
class InstanceMesh {
 public:
  static Result<InstanceMesh> create(const Mesh& mesh, std::size_t slots,
                                     const CharacterInstanceOptions& options);

  /// Notes the changes of a call; update() applies them.
  void note(const MeshChange& change) noexcept;
  /// Applies the noted changes to the skinning data and the buffers. O(changes). @throws
  /// std::bad_alloc; the changes stay noted then.
  Status update(const Mesh& mesh, const InfluencePositions& exact);
  /// Poses the vertices that changed. @param displacements  null: none.
  Status deform(const BonePalette& palette, const ParallelFor& parallel_for,
                const VertexDisplacements* displacements);
  /// Ends a frame in which all meshes were posed: lists what it changed.
  void publish(const Mesh& mesh) noexcept;
  /// Ends a frame that failed: the next one poses every vertex.
  void forget() noexcept { buffer_.set_target(buffer_.target()); }

  /// Whether normals or tangents are posed.
  [[nodiscard]] bool has_directions() const { return has_normals_ || has_tangents_; }
  /// Empty before the first update(), and where triangles changed since the last one.
  [[nodiscard]] PosedMesh posed(const Mesh& mesh) const;

 private:
  explicit InstanceMesh(SkinnedMesh skinned)
      : skinned_(std::move(skinned)), buffer_(VertexTarget()) {}
  void resize(Index vertex_count);

  SkinnedMesh skinned_;
  PosedBuffer buffer_;
  std::vector<Vec3f> positions_, normals_;
  std::vector<Vec4f> tangents_;
  bool has_normals_ = false, has_tangents_ = false, unit_length_ = false;
  Index first_changed_ = kNone;  ///< First vertex whose skinning data changed since the last
                                 ///< update(); kNone: none did.
  /// Vertices that a detachment released, or that its undo returned.
  struct Release {
    bool is_released;
    std::vector<std::uint32_t> vertices;
  };
  void apply_releases();

  std::vector<Release> releases_;   ///< Since the last update(), in order.
  bool has_lost_releases_ = false;  ///< Memory ran out while they were noted.
  PendingRanges triangles_, attributes_;
};

}  // namespace sunder::scene
