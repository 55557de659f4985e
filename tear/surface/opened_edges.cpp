#include "tear/surface/opened_edges.h"

#include <algorithm>
#include <utility>

namespace sunder::tear {

std::vector<Index> OpenedEdges::tracked() const {
  std::vector<Index> tracked;
  for (const Index h : half_edges_)
    if (h < surface_.twin.size() && surface_.corner_point[h] != kNone) tracked.push_back(h);
  std::sort(tracked.begin(), tracked.end());
  return tracked;
}

std::vector<Index> OpenedEdges::borders() const {
  std::vector<Index> borders = tracked();
  std::erase_if(borders, [&](Index h) { return surface_.twin[h] != kNone; });
  return borders;
}

void OpenedEdges::insert(Index half_edge) {
  changes_.emplace_back();  // first, so that nothing fails after the set has changed
  if (half_edges_.insert(half_edge).second)
    changes_.back().inserted = half_edge;
  else
    changes_.pop_back();
}

bool OpenedEdges::extract(Index half_edge) {
  const auto found = half_edges_.find(half_edge);
  if (found == half_edges_.end()) return false;
  changes_.emplace_back();
  changes_.back().extracted = half_edges_.extract(found);
  return true;
}

void OpenedEdges::roll_back(Index change_count) noexcept {
  for (; changes_.size() > change_count; changes_.pop_back()) {
    Change& change = changes_.back();
    if (change.extracted)
      half_edges_.insert(std::move(change.extracted));
    else if (change.inserted != kNone)
      half_edges_.erase(change.inserted);
  }
}

}  // namespace sunder::tear
