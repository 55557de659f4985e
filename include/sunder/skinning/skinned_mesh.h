#pragma once

#include <sunder/core/api.h>
#include <sunder/core/index.h>
#include <sunder/core/mesh.h>
#include <sunder/core/parallel_for.h>
#include <sunder/core/status.h>
#include <sunder/skinning/bone_palette.h>
#include <sunder/skinning/vertex_arrays.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

namespace skinning {
struct Blocks;
}

/// A buffer of posed vertices, and what was last written to it.
class SUNDER_API PosedBuffer {
 public:
  /// @param target  memory of the caller's, which outlives this.
  explicit PosedBuffer(const VertexTarget& target) : target_(target) {}

  /// What the last deform() wrote, ascending and apart: what has to be uploaded. Where vertices are
  /// not ordered by their bones, ranges may hold some that kept their value.
  [[nodiscard]] std::span<const IndexRange> dirty_vertices() const { return dirty_; }
  /// Moves the buffer, or wants other attributes. What it holds counts as lost.
  void set_target(const VertexTarget& target);
  /// The same memory is of so many vertices now, after SkinnedMesh::update().
  void set_vertex_count(std::uint32_t vertex_count) { target_.vertex_count = vertex_count; }
  [[nodiscard]] const VertexTarget& target() const { return target_; }

 private:
  friend class SkinnedMesh;
  VertexTarget target_;
  std::uint64_t palette_ = 0, palette_revision_ = 0;  // 0: nothing was written
  std::uint64_t mesh_ = 0, mesh_revision_ = 0;
  std::vector<IndexRange> dirty_;
  std::vector<std::uint64_t> marks_;      // a bit a block
  std::vector<std::uint64_t> displaced_;  // a bit a block: some of its vertices are; or empty
  std::vector<IndexRange> blocks_to_write_;
};

/// A mesh arranged for skinning: blocks of 16 vertices, each with the bones that move any of them.
class SUNDER_API SkinnedMesh {
 public:
  /// Vertices are blocked in their own order where neighbours share bones; where they do not, they
  /// are gathered by their bones, a few thousand at a time, and written to their places.
  /// order_for_skinning() makes the first, faster case of the second.
  /// @param slots  of the skin.
  /// @return size_mismatch, index_out_of_range, non_finite_value, weights_not_normalized (by more
  /// than a hundredth), with the
  ///         vertex; empty_input without positions or influences; invalid_argument for strides;
  ///         limit_exceeded above 65,536 slots.
  ///
  /// O(V x influences), reads the source and keeps nothing of it.
  [[nodiscard]] static Result<SkinnedMesh> create(const VertexSource& source, std::size_t slots);
  ~SkinnedMesh();
  SkinnedMesh(SkinnedMesh&&) noexcept;
  SkinnedMesh& operator=(SkinnedMesh&&) noexcept;

  [[nodiscard]] std::uint32_t vertex_count() const;
  /// Bytes that a deform() of all vertices reads, but for the palette and morph targets.
  [[nodiscard]] std::size_t stream_bytes() const;

  /// Follows a source whose vertices from `first_changed` on are others, more or fewer: what tears
  /// append and undo takes from the end. The source has the attributes and morph targets that it
  /// had.
  /// @return as create(); nothing is changed then.
  ///
  /// O(vertices from `first_changed` on). Allocates where reserve() did not.
  [[nodiscard]] Status update(const VertexSource& source, std::uint32_t first_changed);
  /// Room for that many vertices more, of `influences` influences on average.
  void reserve(std::uint32_t more_vertices, std::uint32_t influences);

  /// Writes to `buffer` what changed since it was last written: vertices moved by a bone or morph
  /// target that changed, those that update() changed, and those that are displaced or were. All
  /// bits are those of writing everything.
  /// @param displacements  what moves vertices beside their bones; null: nothing. They are
  /// displaced where the bones put them, not
  ///                       where the last call left them.
  /// @return size_mismatch where palette, mesh, buffer and displacements do not fit,
  /// index_out_of_range with the range of moved
  ///         vertices, invalid_argument where the palette has no pose or the mesh lacks an
  ///         attribute that the buffer wants (nothing is written).
  ///
  /// O(vertices moved or displaced + blocks / 64); nothing moved: O(1). Allocates only when the
  /// buffer sees a larger mesh than before, or displaced vertices for the first time. Displaced
  /// vertices are read back from the buffer. Reentrant for different buffers. The same bits on
  /// every CPU, at every number of threads, in every layout: no fused multiply-adds, and a vertex'
  /// influences are summed in the order of their slots, then in that of its particles.
  [[nodiscard]] Status deform(const BonePalette& palette, PosedBuffer& buffer,
                              const ParallelFor& parallel_for = {},
                              const VertexDisplacements* displacements = nullptr) const;

 private:
  explicit SkinnedMesh(std::unique_ptr<skinning::Blocks> blocks);
  std::unique_ptr<skinning::Blocks> blocks_;
};

/// An order of vertices in which neighbours are moved by the same bones, so that SkinnedMesh reads
/// least and writes straight on; of equal bones, the order that there was. For asset pipelines,
/// where vertices may still be renumbered.
/// @return old_from_new. O(V log V).
[[nodiscard]] SUNDER_API std::vector<std::uint32_t> order_for_skinning(const Mesh& mesh);

/// Renumbers the vertices of a mesh: every attribute, the weights, morph targets, and the corners
/// of triangles.
/// @param old_from_new  each vertex once.
/// @return size_mismatch or index_out_of_range (nothing is changed). O(size of the mesh).
[[nodiscard]] SUNDER_API Status reorder_vertices(Mesh& mesh,
                                                 std::span<const std::uint32_t> old_from_new);

}  // namespace sunder
