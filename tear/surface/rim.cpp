#include "tear/surface/rim.h"

#include <algorithm>
#include <map>

#include "tear/internal/surface.h"

namespace sunder::tear {

std::vector<Rim> chain_rims(const std::vector<Index>& half_edges, const Surface& surface) {
  std::map<Index, Index> leaving;  // by point
  std::map<Index, bool> is_entered;
  for (const Index h : half_edges) {
    leaving[surface.corner_point[h]] = h;
    is_entered[surface.corner_point[Surface::next(h)]] = true;
  }
  std::vector<Rim> rims;
  const auto follow = [&](Index point) {
    Rim rim;
    for (auto at = leaving.find(point); at != leaving.end(); at = leaving.find(point)) {
      rim.half_edges.push_back(at->second);
      point = surface.corner_point[Surface::next(at->second)];
      leaving.erase(at);
    }
    rim.is_closed = point == surface.corner_point[rim.half_edges.front()];
    rims.push_back(std::move(rim));
  };
  for (const Index h : half_edges)  // open chains first, then closed ones
    if (!is_entered[surface.corner_point[h]] && leaving.count(surface.corner_point[h]) != 0)
      follow(surface.corner_point[h]);
  for (const Index h : half_edges)
    if (leaving.count(surface.corner_point[h]) != 0) follow(surface.corner_point[h]);
  return rims;
}

}  // namespace sunder::tear
