#include "tear/surface/open.h"

#include <algorithm>

#include "tear/internal/surface.h"
#include "tear/surface/disconnect.h"
#include "tear/surface/sort_by_index.h"

namespace sunder::tear {
namespace {

/// The corners at the end points of the edges, in the faces right and left of them.
class CornersAtPoints {
 public:
  CornersAtPoints(std::size_t edge_count, const Surface& surface, ScratchMemory& scratch)
      : surface_(surface), corners_(&scratch), mentions_(&scratch) {
    corners_.reserve(4 * edge_count);
    mentions_.reserve(4 * edge_count);
  }

  /// Adds the corners by the points that they have now: where a path passes a point again, one of
  /// them may have another point already.
  /// @param joint  the position of the point on the path.
  void add(std::size_t joint, Index right, Index left) {
    mention(joint, 0, right);
    mention(joint, kLeft, left);
  }

  /// Calls visit(point, first joint, corners) by ascending points. Corners right of the edges come
  /// first, then those left of them.
  template <class Visit>
  void for_each_point(Visit visit) {
    std::sort(mentions_.begin(), mentions_.end());
    ScratchVector<Index> of_point(mentions_.get_allocator());
    of_point.reserve(corners_.size());
    for (std::size_t begin = 0, end = 0; begin < mentions_.size(); begin = end) {
      of_point.clear();
      Index joint = kNone;
      const auto point = static_cast<Index>(mentions_[begin] >> 32);
      for (; end < mentions_.size() && mentions_[end] >> 32 == point; ++end) {
        const Mention& mention = corners_[static_cast<Index>(mentions_[end]) & ~kLeft];
        of_point.push_back(mention.corner);
        joint = std::min(joint, mention.joint);
      }
      visit(point, joint, std::span<const Index>(of_point));
    }
  }

 private:
  static constexpr Index kLeft = Index{1} << 31;

  struct Mention {
    Index corner, joint;
  };
  void mention(std::size_t joint, Index side, Index corner) {
    if (corner == kNone) return;
    const std::uint64_t point = surface_.corner_point[corner];
    mentions_.push_back(point << 32 | (side | static_cast<Index>(corners_.size())));
    corners_.push_back({corner, static_cast<Index>(joint)});
  }

  const Surface& surface_;
  ScratchVector<Mention> corners_;
  ScratchVector<std::uint64_t> mentions_;  ///< Point, side and index in corners_, as one number.
};

/// The fans that hold given corners of a point, each from its clockwise end.
class FansAtPoint {
 public:
  FansAtPoint(const Surface& surface, ScratchMemory& scratch)
      : surface_(surface),
        corners_(&scratch),
        begins_(&scratch),
        groups_(&scratch),
        others_(&scratch),
        in_group_(&scratch) {
    corners_.reserve(kMany);
    begins_.reserve(kMany);
    groups_.reserve(kMany);
    others_.reserve(kMany);
  }

  void clear() {
    corners_.clear();
    begins_.clear();
    groups_.clear();
  }
  void add(Index corner) {
    if (std::find(corners_.begin(), corners_.end(), corner) != corners_.end()) return;
    groups_.push_back(static_cast<Index>(begins_.size()));
    begins_.push_back(static_cast<Index>(corners_.size()));
    surface_.for_each_in_fan(corner, [&](Index c) { corners_.push_back(c); });
  }

  [[nodiscard]] std::size_t count() const { return begins_.size(); }
  [[nodiscard]] std::span<const Index> corners(std::size_t fan) const {
    const std::size_t end = fan + 1 < begins_.size() ? begins_[fan + 1] : corners_.size();
    return std::span(corners_).subspan(begins_[fan], end - begins_[fan]);
  }
  /// Puts the fan that begins with a corner and the one that ends with another in one group.
  void join(Index first, Index last) {
    std::size_t a = count(), b = count();
    for (std::size_t fan = 0; fan < count(); ++fan) {
      if (corners(fan).front() == first) a = fan;
      if (corners(fan).back() == last) b = fan;
    }
    if (a == count() || b == count()) return;
    const Index kept = std::min(groups_[a], groups_[b]), other = std::max(groups_[a], groups_[b]);
    std::replace(groups_.begin(), groups_.end(), other, kept);
  }
  /// Whether a fan is the first one of its group.
  [[nodiscard]] bool leads_group(std::size_t fan) const { return groups_[fan] == fan; }
  /// The corners of all fans of a group, by its first fan.
  [[nodiscard]] std::span<const Index> group_corners(std::size_t first_fan) {
    in_group_.clear();
    for (std::size_t fan = 0; fan < count(); ++fan)
      if (groups_[fan] == first_fan)
        in_group_.insert(in_group_.end(), corners(fan).begin(), corners(fan).end());
    return in_group_;
  }
  /// A corner of each fan outside a group.
  [[nodiscard]] std::span<const Index> others(std::size_t first_fan) {
    others_.clear();
    for (std::size_t other = 0; other < begins_.size(); ++other)
      if (groups_[other] != first_fan) others_.push_back(corners_[begins_[other]]);
    return others_;
  }

 private:
  static constexpr std::size_t kMany = 16;

  const Surface& surface_;
  ScratchVector<Index> corners_, begins_;
  ScratchVector<Index> groups_;  ///< Per fan, the first fan of its group.
  ScratchVector<Index> others_, in_group_;
};

/// The half-edges of an edge.
struct OpenedSide {
  Index left = kNone, right = kNone;
};

/// Lips, and the edge that begins between them: lips are reported in the order of the edges.
struct OpenedJoint {
  Index joint;
  LipPair lips;
};

/// Groups the fans of a point that a cap will join.
void join_fans(Index point, std::span<const SectionCorner> section_corners,
               std::span<const OpenedSide> sides, FansAtPoint& fans) {
  const auto first = std::lower_bound(
      section_corners.begin(), section_corners.end(), point,
      [](const SectionCorner& corner, Index wanted) { return corner.point < wanted; });
  for (auto at = first; at != section_corners.end() && at->point == point; ++at) {
    const OpenedSide &arriving = sides[at->arriving], &leaving = sides[at->leaving];
    if (arriving.left == kNone || arriving.right == kNone || leaving.left == kNone ||
        leaving.right == kNone)
      continue;
    fans.join(leaving.left, Surface::next(arriving.left));
    fans.join(arriving.right, Surface::next(leaving.right));
  }
}

/// The half-edges on both sides of each edge.
ScratchVector<OpenedSide> sides_of(std::span<const PointEdge> edges,
                                   std::span<const Index> half_edges, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const auto find = [&](std::size_t i) {
    const auto& [from, to] = edges[i];
    const Index known = i < half_edges.size() ? half_edges[i] : kNone;
    const bool is_right = known != kNone && surface.corner_point[known] == from &&
                          surface.corner_point[Surface::next(known)] == to;
    return is_right ? known : surface.find_half_edge(from, to);
  };
  ScratchVector<OpenedSide> sides(&editor.scratch());
  sides.reserve(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [from, to] = edges[i];
    const Index left = find(i);
    sides.push_back({left, left != kNone ? surface.twin[left] : surface.find_half_edge(to, from)});
  }
  return sides;
}

}  // namespace

void open_edges(std::span<const PointEdge> edges, std::span<const Index> half_edges,
                std::span<const SectionCorner> section_corners, SurfaceEditor& editor,
                std::vector<LipPair>& lips) {
  const Surface& surface = editor.surface();
  // Found before anything is cut: afterwards neither side leads to the other.
  const ScratchVector<OpenedSide> sides = sides_of(edges, half_edges, editor);
  for (const OpenedSide& side : sides)
    if (side.left != kNone && side.right != kNone) cut_edge(side.left, editor);

  // Where a path goes through a point within the surface, two fans remain, each from one of its
  // edges to the other.
  ScratchVector<OpenedJoint> opened(&editor.scratch());
  opened.reserve(edges.size() + 1);
  ScratchVector<bool> is_open(edges.size() + 1, false,
                              &editor.scratch());  // at the beginning of an edge
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Index point = edges[i][0];
    if (point != edges[i - 1][1]) continue;
    const Index made = separate_left_fan(
        {sides[i - 1].left, sides[i].left, sides[i - 1].right, sides[i].right}, editor);
    if (made == kNone) continue;
    is_open[i] = true;
    opened.push_back({static_cast<Index>(i), {made, point}});
  }

  CornersAtPoints corners(edges.size(), surface, editor.scratch());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [left, right] = sides[i];
    if (!is_open[i]) corners.add(i, right == kNone ? kNone : Surface::next(right), left);
    if (!is_open[i + 1]) corners.add(i + 1, right, left == kNone ? kNone : Surface::next(left));
  }
  FansAtPoint fans(surface, editor.scratch());
  corners.for_each_point([&](Index at, Index joint, std::span<const Index> of_point) {
    fans.clear();
    for (const Index corner : of_point) fans.add(corner);
    join_fans(at, section_corners, sides, fans);
    for (std::size_t fan = 1; fan < fans.count(); ++fan)
      if (fans.leads_group(fan))
        opened.push_back(
            {joint, {separate_fan(fans.group_corners(fan), fans.others(fan), editor), at}});
  });
  sort_by_index(
      opened, [](const OpenedJoint& of) { return of.lips.left; }, editor.scratch());
  sort_by_index(
      opened, [](const OpenedJoint& of) { return of.joint; }, editor.scratch());
  for (const OpenedJoint& joint : opened) lips.push_back(joint.lips);
}

void separate_loose_fans(ScratchVector<Index>& corners, SurfaceEditor& editor,
                         std::vector<LipPair>& lips) {
  const Surface& surface = editor.surface();
  const auto point_of = [&](Index corner) { return surface.corner_point[corner]; };
  std::sort(corners.begin(), corners.end(), [&](Index a, Index b) {
    return point_of(a) != point_of(b) ? point_of(a) < point_of(b) : a < b;
  });
  FansAtPoint fans(surface, editor.scratch());
  for (auto begin = corners.begin(); begin != corners.end();) {
    const Index point = point_of(*begin);
    const auto end =
        std::find_if(begin, corners.end(), [&](Index corner) { return point_of(corner) != point; });
    fans.clear();
    for (; begin != end; ++begin) fans.add(*begin);
    for (std::size_t fan = 1; fan < fans.count(); ++fan)
      lips.push_back({separate_fan(fans.corners(fan), fans.others(fan), editor), point});
  }
}

}  // namespace sunder::tear
