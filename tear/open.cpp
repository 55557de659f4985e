#include "tear/open.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Corners that the edges have at one point, in the faces beside them.
struct CornersAtPoint {
  Index point = kNone;
  std::vector<Index> right, left;
};

class Corners {
 public:
  explicit Corners(std::size_t edge_count) { at_points_.reserve(edge_count + 1); }

  void add(Index point, Index right, Index left) {
    // Edges come in runs: a point's last mention is mostly the newest or the one before it.
    auto at = std::find_if(at_points_.rbegin(), at_points_.rend(), [&](const CornersAtPoint& c) { return c.point == point; });
    CornersAtPoint& corners = at != at_points_.rend() ? *at : at_points_.emplace_back(CornersAtPoint{point, {}, {}});
    if (right != kNone) corners.right.push_back(right);
    if (left != kNone) corners.left.push_back(left);
  }
  [[nodiscard]] const std::vector<CornersAtPoint>& at_points() const { return at_points_; }

 private:
  std::vector<CornersAtPoint> at_points_;
};

}  // namespace

void open_edges(const std::vector<PointEdge>& edges, SurfaceEditor& editor, std::vector<LipPair>& lips) {
  const Surface& surface = editor.surface();
  // Found before anything is cut: afterwards the two sides do not know one another.
  Corners corners(edges.size());
  std::vector<Index> to_cut;
  for (const auto& [from, to] : edges) {
    const Index left = surface.find_half_edge(from, to);
    const Index right = left != kNone ? surface.twin[left] : surface.find_half_edge(to, from);
    corners.add(from, right == kNone ? kNone : Surface::next(right), left);
    corners.add(to, right, left == kNone ? kNone : Surface::next(left));
    if (left != kNone && right != kNone) to_cut.push_back(left);
  }
  for (const Index half_edge : to_cut) editor.cut_edge(half_edge);

  std::vector<Index> fans, remaining;
  for (const CornersAtPoint& at : corners.at_points()) {
    // Fans at this point, by their clockwise ends: those right of the edges first, then left.
    fans.clear();
    const auto add = [&](Index corner) {
      const Index fan = surface.first_of_fan(corner);
      if (std::find(fans.begin(), fans.end(), fan) == fans.end()) fans.push_back(fan);
    };
    for (const Index corner : at.right) add(corner);
    for (const Index corner : at.left) add(corner);

    for (std::size_t fan = 1; fan < fans.size(); ++fan) {
      remaining = fans;
      remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(fan));
      const Index point = editor.separate_fan(fans[fan], remaining);
      lips.push_back({point, at.point});
    }
  }
}

}  // namespace sunder::tear
