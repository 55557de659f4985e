#include "tear/section/insertion_order.h"

#include <algorithm>
#include <tuple>

namespace sunder::tear {
namespace {

/// Position of a cell of a 2^16 x 2^16 grid along a Hilbert curve.
std::uint32_t hilbert_place(std::uint32_t x, std::uint32_t y) {
  std::uint32_t place = 0;
  for (std::uint32_t side = 1u << 15; side != 0; side >>= 1) {
    const bool right = (x & side) != 0, up = (y & side) != 0;
    place += side * side * ((right ? 3u : 0u) ^ (up ? 1u : 0u));
    if (!up) {
      if (right) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

/// Length of a run of equal random bits: each round of insertion takes about half of the points
/// that are left.
int rounds_before_last(std::uint64_t seed) {
  seed = (seed + 1) * 0x9E3779B97F4A7C15u;
  seed = (seed ^ (seed >> 30)) * 0xBF58476D1CE4E5B9u;
  seed = (seed ^ (seed >> 27)) * 0x94D049BB133111EBu;
  seed ^= seed >> 31;
  int rounds = 0;
  for (; rounds < 32 && (seed & 1) != 0; seed >>= 1) ++rounds;
  return rounds;
}

}  // namespace

std::pmr::vector<Index> insertion_order(std::span<const Vec2d> points,
                                        std::pmr::memory_resource& memory) {
  std::pmr::vector<Index> order(&memory);
  order.reserve(points.size());
  Vec2d low = points[0], high = points[0];
  for (const Vec2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = std::max(high.x() - low.x(), high.y() - low.y());
  const double cells_per_length = extent > 0 ? 65535 / extent : 0;
  std::pmr::vector<std::tuple<int, std::uint32_t, Index>> keys(&memory);
  keys.reserve(points.size());
  for (Index i = 0; i < points.size(); ++i) {
    const auto x = static_cast<std::uint32_t>((points[i].x() - low.x()) * cells_per_length);
    const auto y = static_cast<std::uint32_t>((points[i].y() - low.y()) * cells_per_length);
    keys.emplace_back(-rounds_before_last(i),
                      hilbert_place(std::min(x, 65535u), std::min(y, 65535u)), i);
  }
  std::sort(keys.begin(), keys.end());
  for (const auto& key : keys) order.push_back(std::get<2>(key));
  return order;
}

}  // namespace sunder::tear
