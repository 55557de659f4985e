#include "tear/open.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Corners that the edges have at their points, in the faces right and left of them.
class CornersAtPoints {
 public:
  CornersAtPoints(std::size_t edge_count, ScratchMemory& scratch) : points_(&scratch), mentions_(&scratch) {
    points_.reserve(edge_count + 1);
    mentions_.reserve(4 * edge_count);
  }

  void add(Index point, Index right, Index left) {
    // Edges come in runs: a point's last mention is mostly the newest or the one before it.
    auto at = std::find_if(points_.rbegin(), points_.rend(), [&](const AtPoint& candidate) { return candidate.point == point; });
    AtPoint& of = at != points_.rend() ? *at : points_.emplace_back(AtPoint{point, {}, {}});
    if (right != kNone) append(of.right, right);
    if (left != kNone) append(of.left, left);
  }

  [[nodiscard]] std::size_t point_count() const { return points_.size(); }
  [[nodiscard]] Index point(std::size_t i) const { return points_[i].point; }
  /// Corners right of the edges first, then those left of them.
  template <class Visit>
  void for_each_corner(std::size_t i, Visit visit) const {
    for (const List& list : {points_[i].right, points_[i].left})
      for (Index m = list.first; m != kNone; m = mentions_[m].next) visit(mentions_[m].corner);
  }

 private:
  struct List {
    Index first = kNone, last = kNone;
  };
  struct AtPoint {
    Index point = kNone;
    List right, left;
  };
  struct Mention {
    Index corner, next;
  };
  void append(List& list, Index corner) {
    const auto mention = static_cast<Index>(mentions_.size());
    mentions_.push_back({corner, kNone});
    (list.first == kNone ? list.first : mentions_[list.last].next) = mention;
    list.last = mention;
  }

  ScratchVector<AtPoint> points_;
  ScratchVector<Mention> mentions_;
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
  CornersAtPoints corners(edges.size(), editor.scratch());
  ScratchVector<Index> to_cut(&editor.scratch());
  to_cut.reserve(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [from, to] = edges[i];
    const Index left = find(i);
    const Index right = left != kNone ? surface.twin[left] : surface.find_half_edge(to, from);
    corners.add(from, right == kNone ? kNone : Surface::next(right), left);
    corners.add(to, right, left == kNone ? kNone : Surface::next(left));
    if (left != kNone && right != kNone) to_cut.push_back(left);
  }
  for (const Index half_edge : to_cut) editor.cut_edge(half_edge);

  // Fans at each point, by their clockwise ends.
  ScratchVector<Index> fans(&editor.scratch()), remaining(&editor.scratch());
  for (std::size_t i = 0; i < corners.point_count(); ++i) {
    fans.clear();
    corners.for_each_corner(i, [&](Index corner) {
      const Index fan = surface.first_of_fan(corner);
      if (std::find(fans.begin(), fans.end(), fan) == fans.end()) fans.push_back(fan);
    });
    for (std::size_t fan = 1; fan < fans.size(); ++fan) {
      remaining = fans;
      remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(fan));
      const Index point = editor.separate_fan(fans[fan], remaining);
      lips.push_back({point, corners.point(i)});
    }
  }
}

}  // namespace sunder::tear
