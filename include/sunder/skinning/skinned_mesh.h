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

/// The vertices of a buffer that are not posed.
struct ReleasedVertices {
  std::vector<std::uint64_t> vertices;  ///< One bit per vertex; empty if none ever was.
  std::vector<std::uint64_t> blocks;    ///< One bit per block: all its vertices are released.
  std::vector<std::uint64_t> returned;  ///< One bit per block: taken back since it was written.
  std::uint64_t mesh_revision = 0;      ///< Of the mesh when `blocks` were listed.
};
}  // namespace skinning

/// A buffer of posed vertices, and the state that was last written to it.
///
/// Not thread-safe: one deform() at a time per buffer. Different buffers may be written
/// concurrently.
class SUNDER_API PosedBuffer {
 public:
  /// @param target  memory owned by the caller; it must outlive the buffer.
  explicit PosedBuffer(const VertexTarget& target) : target_(target) {}

  /// The vertices written by the last deform(), as ascending disjoint ranges: what has to be
  /// uploaded. If the mesh gathers its vertices by bones, ranges may include vertices that did not
  /// change.
  [[nodiscard]] std::span<const IndexRange> dirty_vertices() const { return dirty_; }
  /// Replaces the memory or the requested attributes. The next deform() writes everything.
  void set_target(const VertexTarget& target);
  /// Sets the vertex count, after SkinnedMesh::update(); the memory stays the same.
  void set_vertex_count(std::uint32_t vertex_count) { target_.vertex_count = vertex_count; }
  [[nodiscard]] const VertexTarget& target() const { return target_; }

 private:
  friend class SkinnedMesh;
  VertexTarget target_;
  std::uint64_t palette_ = 0, palette_revision_ = 0;  // 0: nothing was written
  std::uint64_t mesh_ = 0, mesh_revision_ = 0;
  std::vector<IndexRange> dirty_;
  std::vector<std::uint64_t> marks_;  // one bit per block
  std::vector<std::uint64_t>
      displaced_;  // one bit per block: some of its vertices are displaced; or empty
  std::vector<IndexRange> blocks_to_write_;
  skinning::ReleasedVertices released_;
};

/// Whether a mesh may gather its vertices by their bones.
enum class VertexGathering : std::uint8_t {
  allowed,  ///< Poses faster. To be preferred for meshes that are posed again and again.
  none,     ///< Vertices keep their order. Takes a third of the time to create.
};

/// A mesh prepared for skinning: blocks of 16 vertices, each with the bones that move any of them.
///
/// Const functions are reentrant. update() and reserve() must not run at the same time as any other
/// use of the same mesh.
class SUNDER_API SkinnedMesh {
 public:
  /// Vertices keep their order if neighbours share bones; otherwise up to 4,096 at a time are
  /// gathered by their bones and scattered when written. order_for_skinning() avoids the second,
  /// slower case. Posed vertices have the same bits in any order.
  /// @param source  read during the call only.
  /// @param slots   number of slots of the skin.
  /// @return size_mismatch, index_out_of_range, non_finite_value, weights_not_normalized (by more
  /// than 1 %), with the vertex; empty_input without positions or influences; invalid_argument for
  /// strides; limit_exceeded above 65,536 slots or out of memory. O(V x influences), allocates.
  [[nodiscard]] static Result<SkinnedMesh> create(
      const VertexSource& source, std::size_t slots,
      VertexGathering gathering = VertexGathering::allowed);
  ~SkinnedMesh();
  SkinnedMesh(SkinnedMesh&&) noexcept;
  SkinnedMesh& operator=(SkinnedMesh&&) noexcept;

  [[nodiscard]] std::uint32_t vertex_count() const;
  /// Number of bytes that deform() reads for all vertices, without the palette and morph targets.
  [[nodiscard]] std::size_t stream_bytes() const;

  /// Follows a source that changed from vertex `first_changed` on, as tears append vertices and
  /// undo removes them. Attributes and morph targets must be the same as before.
  /// @return as create(); the mesh is unchanged on failure.
  /// O(vertices from `first_changed` on). Allocates unless reserve() made room.
  [[nodiscard]] Status update(const VertexSource& source, std::uint32_t first_changed);
  /// Makes room for that many more vertices, with `influences` influences each on average.
  /// @return limit_exceeded: out of memory.
  Status reserve(std::uint32_t more_vertices, std::uint32_t influences);

  /// Writes the vertices of `buffer` that changed since it was last written: those moved by a
  /// changed bone or morph target, those changed by update(), and those that are or were displaced.
  /// The result has the same bits as writing everything.
  /// @param displacements  displacements added to the posed vertices; null: none.
  /// @return size_mismatch if palette, mesh, buffer and displacements do not fit together;
  /// index_out_of_range with the range of displaced vertices; invalid_argument if the palette has
  /// no pose or the mesh lacks a requested attribute; limit_exceeded: out of memory. Nothing is
  /// written then.
  ///
  /// O(vertices moved or displaced + blocks / 64); O(1) if nothing moved. Allocates only if the
  /// buffer sees a larger mesh, or displaced vertices, for the first time. Deterministic: the same
  /// bits on every CPU, for any number of threads and any layout (docs/skinning.md).
  [[nodiscard]] Status deform(const BonePalette& palette, PosedBuffer& buffer,
                              const ParallelFor& parallel_for = {},
                              const VertexDisplacements* displacements = nullptr) const;

  /// Stops posing vertices of a buffer, such as MeshChange::released: deform() leaves out blocks of
  /// vertices that are all released. Their memory keeps what was written last, which is nothing in
  /// a new buffer. take_back() poses them again, as after MeshChange::returned.
  /// @return index_out_of_range with the place in `vertices`, limit_exceeded (out of memory):
  /// nothing is changed. O(vertices of the mesh), allocates.
  [[nodiscard]] Status release(std::span<const std::uint32_t> vertices, PosedBuffer& buffer) const;
  [[nodiscard]] Status take_back(std::span<const std::uint32_t> vertices,
                                 PosedBuffer& buffer) const;

 private:
  explicit SkinnedMesh(std::unique_ptr<skinning::Blocks> blocks);
  Status set_released(std::span<const std::uint32_t> vertices, bool is_released,
                      PosedBuffer& buffer) const;
  std::unique_ptr<skinning::Blocks> blocks_;
};

/// An order of the vertices in which neighbours are moved by the same bones, for asset pipelines
/// that may still renumber vertices. Stable among vertices with the same bones.
/// @return old_from_new; limit_exceeded: out of memory. O(V log V), allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<std::vector<std::uint32_t>> order_for_skinning(const Mesh& mesh);

/// Renumbers the vertices of a mesh: all attributes, weights, morph targets, and triangles.
/// @param old_from_new  each vertex once.
/// @return size_mismatch, index_out_of_range, or limit_exceeded, out of memory (the mesh is
/// unchanged). O(size of the mesh), allocates.
[[nodiscard]] SUNDER_API Status reorder_vertices(Mesh& mesh,
                                                 std::span<const std::uint32_t> old_from_new);

}  // namespace sunder
