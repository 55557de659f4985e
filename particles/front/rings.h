#pragma once

#include <sunder/core/index.h>

#include <array>
#include <span>
#include <vector>

#include "core/internal/prefetch.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
using tear::Surface;

/// Number of points, and of faces, in a RingBlock.
inline constexpr std::size_t kRingLanes = 8, kRingFaces = kRingLanes - 1;

/// Some of the points around a point. Consecutive points share a face; the last one is repeated as
/// the first of the next block. Lanes after the last point contain the point in the middle at an
/// infinite distance, so that loops over lanes have a fixed length.
struct alignas(32) RingBlock {
  std::array<Index, kRingLanes> points;
  /// Lengths of the edges from the point in the middle, one per lane.
  std::array<float, kRingLanes> lengths;
  /// Lengths of the edges to the next lane's point; NaN if no face is between them.
  std::array<float, kRingLanes> opposite;
};

/// The points around a point, counter-clockwise; if they form a closed circle, the first one is
/// repeated at the end. Points without a position yet are left out.
class Ring {
 public:
  Ring(const RingBlock* blocks, std::size_t size) : blocks_(blocks), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Index point(std::size_t i) const { return blocks_[block_of(i)].points[lane_of(i)]; }
  [[nodiscard]] float length(std::size_t i) const {
    return blocks_[block_of(i)].lengths[lane_of(i)];
  }
  [[nodiscard]] float opposite(std::size_t i) const {
    return blocks_[block_of(i)].opposite[lane_of(i)];
  }
  [[nodiscard]] std::span<const RingBlock> blocks() const { return {blocks_, block_count()}; }

 private:
  [[nodiscard]] std::size_t block_count() const {
    return size_ < 2 ? size_ : (size_ + kRingFaces - 2) / kRingFaces;
  }
  /// Only a last lane contains the very last point.
  [[nodiscard]] std::size_t block_of(std::size_t i) const {
    return std::min(i / kRingFaces, block_count() - 1);
  }
  [[nodiscard]] std::size_t lane_of(std::size_t i) const { return i - kRingFaces * block_of(i); }

  const RingBlock* blocks_;
  std::size_t size_;
};

/// The rings of all points of a surface. On large surfaces each is computed on first use, so that
/// rings of neighbouring points are close in memory.
class Rings {
 public:
  ///
  /// @param surface, positions  must outlive this and not change.
  Rings(const Surface& surface, std::span<const Vec3f> positions);
  /// Prefetches the ring of a point.
  void expect(Index point) const {
    if (!are_many_ || ends_[point].first == kNone) return;
    const RingBlock& block = blocks_[ends_[point].first];
    prefetch(&block);
    prefetch(&block.opposite.back());
  }
  /// Valid until the next call.
  [[nodiscard]] Ring operator()(Index point) {
    Ends& ends = ends_[point];
    if (ends.first == kNone) look_up(point, ends);
    return {blocks_.data() + ends.first, ends.size};
  }

 private:
  struct Ends {
    Index first = kNone, size = 0;
  };
  void look_up(Index point, Ends& ends);

  const Surface& surface_;
  std::span<const Vec3f> positions_;
  std::vector<Ends> ends_;
  bool are_many_;
  std::vector<RingBlock> blocks_;
};

/// The same, computed in each call.
class RingWalk {
 public:
  /// @param positions  may grow meanwhile.
  RingWalk(const Surface& surface, const std::vector<Vec3f>& positions)
      : surface_(surface), positions_(positions) {}
  void expect(Index) const {}
  /// Valid until the next call.
  [[nodiscard]] Ring operator()(Index point);

 private:
  const Surface& surface_;
  const std::vector<Vec3f>& positions_;
  std::vector<RingBlock> blocks_;
};

}  // namespace sunder::particles
