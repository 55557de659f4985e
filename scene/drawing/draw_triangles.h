#pragma once

#include <sunder/scene/character_instance.h>

#include <vector>

#include "scene/drawing/draw_order.h"

namespace sunder::scene {

/// The index buffer of a torn mesh, as differences from that of its asset. Triangles of the source
/// keep their places. Appended ones lie behind them, in one chunk per submesh, so that each submesh
/// is drawn by at most two ranges; a chunk that is full moves to the end with twice the capacity.
class DrawTriangles {
 public:
  explicit DrawTriangles(const DrawOrder& order) : order_(&order), end_(order.triangle_count()) {}

  /// Notes the changes of a call; update() applies them.
  void note(const MeshChange& change) noexcept;
  /// Makes the buffer that of `mesh`. O(noted changes), amortised. @throws std::bad_alloc; call it
  /// again then.
  void update(const Mesh& mesh, std::uint64_t epoch);

  [[nodiscard]] std::span<const DrawRange> ranges() const {
    return is_torn_ ? std::span<const DrawRange>(ranges_) : order_->ranges();
  }
  [[nodiscard]] Index capacity() const { return end_; }
  /// Writes what changed after an epoch. @throws std::bad_alloc
  void collect(std::uint64_t seen, std::vector<TriangleWrite>& writes) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Chunk {
    Index first = 0, capacity = 0;
    std::vector<Index> triangles;  ///< Those of the mesh, in their order in the buffer.
  };
  struct Epoch {
    std::uint64_t epoch;
    std::size_t first;  ///< Its first entry in log_.
  };
  void shrink(const Mesh& mesh);
  void append(const Mesh& mesh);
  void grow(Chunk& chunk, const Mesh& mesh);
  void log(Index triangle, const Mesh& mesh) {
    log_.push_back({place(triangle), mesh.triangles[triangle]});
  }
  void shorten_log();
  void list_ranges(const Mesh& mesh);
  [[nodiscard]] Index place(Index triangle) const {
    return triangle < order_->triangle_count() ? order_->place(triangle)
                                               : places_[triangle - order_->triangle_count()];
  }

  const DrawOrder* order_;
  bool is_torn_ = false;
  bool lost_count_ = false;  ///< Memory ran out in note(): every triangle may have changed.
  Index first_appended_ =
      kNone;                    ///< Appended triangles from here on may have changed; kNone: none.
  std::vector<Index> noted_;    ///< Rewritten triangles.
  std::vector<Index> places_;   ///< Per appended triangle.
  std::vector<Index> submesh_;  ///< Per appended triangle.
  std::vector<Chunk> chunks_;   ///< Per submesh.
  Index end_;
  std::vector<DrawRange> ranges_;
  /// In the order in which they were made. The model may be packed, so triangles are kept here.
  std::vector<TriangleWrite> log_;
  std::vector<Epoch> epochs_;
  std::size_t next_shortening_ = 4096;  ///< Size of log_ at which repetitions are removed.
};

}  // namespace sunder::scene
