#include "tear/open.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// The two corners that a path edge has at one of its ends, one in the face at each side of it; kNone beyond a border.
struct CornersAtEdge {
  Index left = kNone;
  Index right = kNone;
};

struct PathEdge {
  CornersAtEdge at_begin, at_end;
};

/// Found before anything is cut: afterwards the two sides do not know one another.
PathEdge find_edge(const Surface& surface, Index from, Index to) {
  PathEdge edge;
  Index left = surface.find_half_edge(from, to);
  Index right = left != kNone ? surface.twin[left] : surface.find_half_edge(to, from);
  if (left != kNone) edge.at_begin.left = left, edge.at_end.left = Surface::next(left);
  if (right != kNone) edge.at_begin.right = Surface::next(right), edge.at_end.right = right;
  return edge;
}

}  // namespace

void open_path(const std::vector<Index>& path, SurfaceEditor& editor, Index& side, std::vector<LipPair>& lips) {
  const Surface& surface = editor.surface();
  std::vector<PathEdge> edges;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) edges.push_back(find_edge(surface, path[i], path[i + 1]));
  for (const PathEdge& edge : edges)
    if (edge.at_begin.left != kNone && edge.at_begin.right != kNone) editor.cut_edge(edge.at_begin.left);

  Index highest_side = side;
  std::vector<Index> fans, remaining;
  for (std::size_t i = 0; i < path.size(); ++i) {
    // Fans at this point, by their clockwise ends: those right of the path first, then left.
    fans.clear();
    const auto add = [&](Index corner) {
      if (corner == kNone) return;
      const Index fan = surface.first_of_fan(corner);
      if (std::find(fans.begin(), fans.end(), fan) == fans.end()) fans.push_back(fan);
    };
    if (i < edges.size()) add(edges[i].at_begin.right);
    if (i > 0) add(edges[i - 1].at_end.right);
    if (i < edges.size()) add(edges[i].at_begin.left);
    if (i > 0) add(edges[i - 1].at_end.left);

    Index of_place = side;
    for (std::size_t fan = 1; fan < fans.size(); ++fan) {
      remaining = fans;
      remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(fan));
      const Index point = editor.separate_fan(fans[fan], of_place, remaining);
      highest_side = std::max(highest_side, of_place++);
      lips.push_back({point, path[i]});
    }
  }
  side = highest_side + 1;
}

}  // namespace sunder::tear
