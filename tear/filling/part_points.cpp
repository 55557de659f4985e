#include "tear/filling/part_points.h"

#include <algorithm>
#include <numeric>

#include "core/internal/ordered.h"

namespace sunder::tear {

void part_touching_points(FlatLoop& loop, ScratchMemory& scratch) {
  constexpr double kPart = 1e-7;
  ScratchVector<std::size_t> order(loop.size(), 0, &scratch);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return loop[a] != loop[b] ? is_left_of(loop[a], loop[b]) : a < b;
  });
  const auto is_same = [&](std::size_t i, std::size_t k) {
    return loop[order[i]] == loop[order[k]];
  };
  ScratchVector<std::pair<std::size_t, Vec2d>> moves(&scratch);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!((i > 0 && is_same(i - 1, i)) || (i + 1 < order.size() && is_same(i, i + 1)))) continue;
    const std::size_t at = order[i];
    const Vec2d back = loop[(at + loop.size() - 1) % loop.size()] - loop[at],
                ahead = loop[(at + 1) % loop.size()] - loop[at];
    const double to_back = norm(back), to_ahead = norm(ahead);
    if (!(to_back > 0) || !(to_ahead > 0)) continue;
    Vec2d between = back / to_back + ahead / to_ahead;
    const double turn = ahead.x() * back.y() - ahead.y() * back.x();
    if (norm(between) < kPart)
      between = Vec2d(-ahead.y(), ahead.x()) / to_ahead;  // straight on
    else if (turn < 0)
      between = -between;
    moves.push_back({at, kPart * std::min(to_back, to_ahead) / norm(between) * between});
  }
  for (const auto& [at, move] : moves) loop[at] += move;
}

bool part_close_points(FlatLoop& loop, double close) {
  const std::size_t count = loop.size();
  const auto at = [&](std::size_t i) -> Vec2d& { return loop[i % count]; };
  const auto is_close = [&](std::size_t i) { return norm(Vec2d(at(i + 1) - at(i))) < close; };
  std::size_t start = 0;
  while (start < count && is_close(start + count - 1)) ++start;
  if (start == count) return false;
  bool has_moved = false;
  for (std::size_t first = start, last = start; first < start + count; first = last = last + 1) {
    while (is_close(last)) ++last;
    if (last == first) continue;
    const Vec2d back = at(first + count - 1) - at(first), ahead = at(last + 1) - at(last);
    const double to_back = norm(back), to_ahead = norm(ahead);
    if (std::min(to_back, to_ahead) < 4 * close) continue;
    const Vec2d begin = at(first) + close / to_back * back,
                end = at(last) + close / to_ahead * ahead;
    for (std::size_t i = first; i <= last; ++i)
      at(i) = begin +
              static_cast<double>(i - first) / static_cast<double>(last - first) * (end - begin);
    has_moved = true;
  }
  return has_moved;
}

}  // namespace sunder::tear
