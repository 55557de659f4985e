#include "particles/clusters/member_search.h"

namespace sunder::particles {

std::span<const Index> MemberSearch::members_of(Index particle) {
  const PointTable& points = structure_.points;
  Index first = kNone, last = 0;
  const auto add = [&](Index point) {
    (void)is_candidate_.set(point, true);
    first = std::min(first, point);
    last = std::max(last, point);
  };
  structure_.for_each_decomposed(particle, add);
  structure_.for_each_joined(particle, [&](Index point) {
    if (points.find(point, particle) != nullptr) add(point);
  });
  found_.clear();
  is_candidate_.take_ones(first, last, [&](Index point) {
    if (points.has_decomposed(point) || points.find(point, particle) != nullptr)
      found_.push_back(point);
  });
  return found_;
}

}  // namespace sunder::particles
