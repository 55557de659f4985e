#include "particles/clusters/member_search.h"

namespace sunder::particles {

std::span<const Index> MemberSearch::members_of(Index particle) {
  Index first = structure_.points.count(), left = 0;
  structure_.for_each_candidate(particle, [&](Index point) {
    left += is_candidate_.set(point, true);
    first = std::min(first, point);
  });
  found_.clear();
  while (left > 0) {
    const Index at = is_candidate_.next_one(first);
    is_candidate_.set(at, false);
    --left;
    first = at + 1;
    if (structure_.points.find(at, particle) != nullptr) found_.push_back(at);
  }
  return found_;
}

}  // namespace sunder::particles
