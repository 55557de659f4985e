#include "tear/surface/opened_edges.h"

#include <algorithm>

namespace sunder::tear {

std::vector<Index> OpenedEdges::borders() const {
  std::vector<Index> borders;
  for (const Index h : half_edges_)
    if (h < surface_.twin.size() && surface_.twin[h] == kNone && surface_.corner_point[h] != kNone)
      borders.push_back(h);
  std::sort(borders.begin(), borders.end());
  return borders;
}

}  // namespace sunder::tear
