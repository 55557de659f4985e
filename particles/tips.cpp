// Where the two lips of a tear meet.

#include <sunder/particles/particle_set.h>

#include <algorithm>

#include "particles/clusters/lip_border.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {
namespace {

/// The end of a gap has no more points than this, or is none.
constexpr int kMostOfEnd = 64;

}  // namespace

std::vector<Index> find_tips(const TornModel& model, const Structure& structure) {
  const LipBorder border(model);
  std::vector<Index> tips;
  std::vector<Index> end;
  for (const LipEdge& edge : structure.lips) {
    const LipPoint& lip = structure.lip_points[edge.points[0]];
    if (edge.points[0] == edge.points[1] || lip.tear == kNone) continue;
    // From the last point of a lip over the end of the tear to the first of the other.
    end.clear();
    for (Index at = border.next(edge.points[0]); at != kNone && static_cast<int>(end.size()) < kMostOfEnd; at = border.next(at)) {
      const LipPoint& of = structure.lip_points[at];
      if (of.tear == lip.tear && of.side == lip.side) break;
      if (of.tear == lip.tear) {
        if (!end.empty()) tips.push_back(end[end.size() / 2]);
        break;
      }
      end.push_back(at);
    }
  }
  std::sort(tips.begin(), tips.end());
  tips.erase(std::unique(tips.begin(), tips.end()), tips.end());
  return tips;
}

}  // namespace sunder::particles

namespace sunder {

std::vector<std::uint32_t> ParticleSet::tips(const TornModel& model) const { return particles::find_tips(model, *structure_); }

}  // namespace sunder
