#include "particles/structure.h"

namespace sunder::particles {

std::vector<Index> Structure::members_of(Index particle) const {
  std::vector<Index> found;
  const auto add = [&](Index point) {
    if (point < point_count() && find(point, particle) != nullptr) found.push_back(point);
  };
  if (particle + 1 < first_member.size())
    for (Index m = first_member[particle]; m < first_member[particle + 1]; ++m) add(members[m]);
  for (const Index point : joined[particle]) add(point);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace sunder::particles
