#include "tear/open.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Corners that the edges have at their points, in the faces right and left of them.
class CornersAtPoints {
 public:
  CornersAtPoints(std::size_t edge_count, ScratchMemory& scratch) : corners_(&scratch), mentions_(&scratch) {
    corners_.reserve(4 * edge_count);
    mentions_.reserve(4 * edge_count);
  }

  void add(Index point, Index right, Index left) {
    mention(point, 0, right);
    mention(point, kLeft, left);
  }

  /// Calls visit(point, its corners) by ascending points. Corners right of the edges come first, then those left of them.
  template <class Visit>
  void for_each_point(Visit visit) {
    std::sort(mentions_.begin(), mentions_.end());
    ScratchVector<Index> of_point(corners_.get_allocator());
    of_point.reserve(corners_.size());
    for (std::size_t begin = 0, end = 0; begin < mentions_.size(); begin = end) {
      of_point.clear();
      const auto point = static_cast<Index>(mentions_[begin] >> 32);
      for (; end < mentions_.size() && mentions_[end] >> 32 == point; ++end)
        of_point.push_back(corners_[static_cast<Index>(mentions_[end]) & ~kLeft]);
      visit(point, std::span<const Index>(of_point));
    }
  }

 private:
  static constexpr Index kLeft = Index{1} << 31;

  void mention(Index point, Index side, Index corner) {
    if (corner == kNone) return;
    mentions_.push_back(std::uint64_t{point} << 32 | (side | static_cast<Index>(corners_.size())));
    corners_.push_back(corner);
  }

  ScratchVector<Index> corners_;
  ScratchVector<std::uint64_t> mentions_;  ///< Point, side, and place in corners_, as one number.
};

/// The fans that hold some corners of a point, each from its clockwise end.
class FansAtPoint {
 public:
  FansAtPoint(const Surface& surface, ScratchMemory& scratch)
      : surface_(surface), corners_(&scratch), begins_(&scratch), others_(&scratch) {
    corners_.reserve(kMany);
    begins_.reserve(kMany);
    others_.reserve(kMany);
  }

  void clear() {
    corners_.clear();
    begins_.clear();
  }
  void add(Index corner) {
    if (std::find(corners_.begin(), corners_.end(), corner) != corners_.end()) return;
    begins_.push_back(static_cast<Index>(corners_.size()));
    surface_.for_each_in_fan(corner, [&](Index c) { corners_.push_back(c); });
  }

  [[nodiscard]] std::size_t count() const { return begins_.size(); }
  [[nodiscard]] std::span<const Index> corners(std::size_t fan) const {
    const std::size_t end = fan + 1 < begins_.size() ? begins_[fan + 1] : corners_.size();
    return std::span(corners_).subspan(begins_[fan], end - begins_[fan]);
  }
  /// A corner of each other fan.
  [[nodiscard]] std::span<const Index> others(std::size_t fan) {
    others_.clear();
    for (std::size_t other = 0; other < begins_.size(); ++other)
      if (other != fan) others_.push_back(corners_[begins_[other]]);
    return others_;
  }

 private:
  static constexpr std::size_t kMany = 16;

  const Surface& surface_;
  ScratchVector<Index> corners_, begins_, others_;
};

/// Half-edges of an edge.
struct Side {
  Index left = kNone, right = kNone;
};

}  // namespace

void open_edges(std::span<const PointEdge> edges, std::span<const Index> half_edges, SurfaceEditor& editor,
                std::vector<LipPair>& lips) {
  const Surface& surface = editor.surface();
  const auto find = [&](std::size_t i) {
    const auto& [from, to] = edges[i];
    const Index known = i < half_edges.size() ? half_edges[i] : kNone;
    const bool is_right = known != kNone && surface.corner_point[known] == from && surface.corner_point[Surface::next(known)] == to;
    return is_right ? known : surface.find_half_edge(from, to);
  };
  // Found before anything is cut: afterwards the two sides do not know one another.
  ScratchVector<Side> sides(&editor.scratch());
  sides.reserve(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [from, to] = edges[i];
    const Index left = find(i);
    sides.push_back({left, left != kNone ? surface.twin[left] : surface.find_half_edge(to, from)});
  }
  for (const Side& side : sides)
    if (side.left != kNone && side.right != kNone) editor.cut_edge(side.left);

  // Where a path goes through a point within the surface, two fans are left, each from one of its edges to the other.
  ScratchVector<bool> is_open(edges.size() + 1, false, &editor.scratch());  // at the beginning of an edge
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Index point = edges[i][0];
    if (point != edges[i - 1][1]) continue;
    const Index made = editor.separate_left(sides[i - 1].left, sides[i].left, sides[i - 1].right, sides[i].right);
    if (made == kNone) continue;
    is_open[i] = true;
    lips.push_back({made, point});
  }

  CornersAtPoints corners(edges.size(), editor.scratch());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [from, to] = edges[i];
    const auto& [left, right] = sides[i];
    if (!is_open[i]) corners.add(from, right == kNone ? kNone : Surface::next(right), left);
    if (!is_open[i + 1]) corners.add(to, right, left == kNone ? kNone : Surface::next(left));
  }
  FansAtPoint fans(surface, editor.scratch());
  corners.for_each_point([&](Index at, std::span<const Index> of_point) {
    fans.clear();
    for (const Index corner : of_point) fans.add(corner);
    for (std::size_t fan = 1; fan < fans.count(); ++fan)
      lips.push_back({editor.separate_fan(fans.corners(fan), fans.others(fan)), at});
  });
}

}  // namespace sunder::tear
