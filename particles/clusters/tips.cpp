#include "particles/clusters/tips.h"

#include <algorithm>

#include "particles/clusters/lip_border.h"

namespace sunder::particles {
namespace {

/// A border between two lips that has more points than this is not the end of a gap.
constexpr std::size_t kMostPointsOfEnd = 64;

/// The middle of the border from the last point of a lip across the end of the tear to the first
/// point of the other lip; kNone if the border leads elsewhere.
/// @param end  scratch.
Index find_tip(const LipBorder& border, const PointTable& points, const LipPoint& lip, Index start,
               std::vector<Index>& end) {
  end.clear();
  for (Index at = border.next(start); at != kNone && end.size() < kMostPointsOfEnd;
       at = border.next(at)) {
    const LipPoint& of = points.lip_points[at];
    if (of.tear == lip.tear) {
      if (of.side == lip.side || end.empty()) return kNone;
      return end[end.size() / 2];
    }
    end.push_back(at);
  }
  return kNone;
}

}  // namespace

std::vector<Index> find_tips(const TornModel& model, const Structure& structure) {
  const LipBorder border(model);
  std::vector<Index> tips, end;
  for (const LipEdge& edge : structure.lips) {
    const LipPoint& lip = structure.points.lip_points[edge.points[0]];
    if (edge.points[0] == edge.points[1] || lip.tear == kNone) continue;
    const Index tip = find_tip(border, structure.points, lip, edge.points[0], end);
    if (tip != kNone) tips.push_back(tip);
  }
  std::sort(tips.begin(), tips.end());
  tips.erase(std::unique(tips.begin(), tips.end()), tips.end());
  return tips;
}

}  // namespace sunder::particles
