#include "particles/front/rings.h"

#include <cmath>
#include <limits>

#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// Up to this number of rings stay in a cache, in any order.
constexpr Index kFew = 8000;

float distance_between(const Vec3f& a, const Vec3f& b) {
  const float x = b.x() - a.x(), y = b.y() - a.y(), z = b.z() - a.z();
  return std::sqrt(x * x + y * y + z * z);
}

/// Appends the blocks of a point's ring. @return its size.
Index append_ring(const Surface& surface, std::span<const Vec3f> positions, Index point,
                  std::vector<RingBlock>& blocks) {
  const Index start = surface.point_corner[point];
  if (start == kNone) return 0;
  RingBlock empty;
  empty.points.fill(point);
  empty.lengths.fill(std::numeric_limits<float>::infinity());
  empty.opposite.fill(std::numeric_limits<float>::quiet_NaN());
  const std::size_t first_block = blocks.size();
  Index size = 0;
  std::size_t lane = kRingLanes;
  Index previous = kNone;  // of the face between it and the next point; none if that is left out
  const auto add = [&](Index other) {
    if (other >= positions.size()) {  // it came since
      previous = kNone;
      return;
    }
    if (lane == kRingLanes) {
      blocks.push_back(empty);
      lane = 0;
      if (size > 0) {
        const RingBlock& full = *(blocks.end() - 2);
        blocks.back().points[lane] = full.points.back();
        blocks.back().lengths[lane++] = full.lengths.back();
      }
    }
    RingBlock& block = blocks.back();
    block.points[lane] = other;
    block.lengths[lane] = distance_between(positions[point], positions[other]);
    if (previous != kNone)
      block.opposite[lane - 1] = distance_between(positions[previous], positions[other]);
    previous = other;
    ++lane;
    ++size;
  };
  const auto walk = [&](Index first) {
    add(surface.corner_point[Surface::next(first)]);
    Index corner = first;
    do {
      const Index back = Surface::previous(corner);
      add(surface.corner_point[back]);
      corner = surface.twin[back];
    } while (corner != kNone && corner != first);
    return corner != kNone;
  };
  if (walk(start)) return size;
  const Index first = surface.first_of_fan(start);
  if (first == start) return size;
  blocks.resize(first_block);  // the ring is open, and began in the middle
  size = 0;
  lane = kRingLanes;
  previous = kNone;
  walk(first);
  return size;
}

}  // namespace

Rings::Rings(const Surface& surface, std::span<const Vec3f> positions)
    : surface_(surface),
      positions_(positions),
      ends_(surface.point_count()),
      are_many_(surface.point_count() > kFew) {
  blocks_.reserve(surface.point_count() + surface.point_count() / 4 + 8);
  if (are_many_) return;
  for (Index point = 0; point < surface.point_count(); ++point) look_up(point, ends_[point]);
}

void Rings::look_up(Index point, Ends& ends) {
  const auto first = static_cast<Index>(blocks_.size());
  ends = {first, append_ring(surface_, positions_, point, blocks_)};
}

Ring RingWalk::operator()(Index point) {
  blocks_.clear();
  const Index size = append_ring(surface_, positions_, point, blocks_);
  return {blocks_.data(), size};
}

}  // namespace sunder::particles
