#include "tear/surface/rim.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Half-edges by the points that they leave.
class Leaving {
 public:
  Leaving(std::span<const Index> half_edges, const Surface& surface, ScratchMemory& scratch)
      : surface_(surface), entries_(&scratch), ends_(&scratch) {
    entries_.reserve(half_edges.size());
    ends_.reserve(half_edges.size());
    for (const Index h : half_edges) {
      entries_.push_back({surface.corner_point[h], h, false});
      ends_.push_back(surface.corner_point[Surface::next(h)]);
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.point != b.point ? a.point < b.point : a.half_edge < b.half_edge;
    });
    std::sort(ends_.begin(), ends_.end());
  }

  /// @return the half-edge that leaves a point, once; then kNone.
  Index take(Index point) {
    const auto entry = std::lower_bound(entries_.begin(), entries_.end(), point,
                                        [](const Entry& e, Index p) { return e.point < p; });
    if (entry == entries_.end() || entry->point != point || entry->is_taken) return kNone;
    entry->is_taken = true;
    return entry->half_edge;
  }
  void take_half_edge(Index half_edge) {
    const Index point = surface_.corner_point[half_edge];
    const auto found = std::find_if(
        std::lower_bound(entries_.begin(), entries_.end(), point,
                         [](const Entry& entry, Index p) { return entry.point < p; }),
        entries_.end(), [&](const Entry& entry) { return entry.half_edge == half_edge; });
    if (found != entries_.end()) found->is_taken = true;
  }
  [[nodiscard]] bool is_entered(Index point) const {
    return std::binary_search(ends_.begin(), ends_.end(), point);
  }

 private:
  struct Entry {
    Index point, half_edge;
    bool is_taken;
  };
  const Surface& surface_;
  ScratchVector<Entry> entries_;
  ScratchVector<Index> ends_;
};

/// The number of half-edges at the beginning that are a closed chain, one after the other; 0 if
/// there is none.
template <class Begins, class Ends>
std::size_t closed_chain(std::span<const Index> half_edges, Begins begins, Ends ends) {
  for (std::size_t i = 0; i < half_edges.size(); ++i) {
    if (ends(half_edges[i]) == begins(half_edges[0])) return i + 1;
    if (i + 1 == half_edges.size() || ends(half_edges[i]) != begins(half_edges[i + 1])) return 0;
  }
  return 0;
}

/// Chains half-edges that are in order, as those of a cut are on one side, or in reversed order, as
/// on the other. @return false if not all are in closed chains in order.
bool chain_in_order(std::span<const Index> half_edges, const Surface& surface,
                    ScratchMemory& scratch, ScratchVector<Rim>& rims) {
  const auto begins = [&](Index h) { return surface.corner_point[h]; };
  const auto ends = [&](Index h) { return surface.corner_point[Surface::next(h)]; };
  while (!half_edges.empty()) {
    std::size_t count = closed_chain(half_edges, begins, ends);
    const bool is_forward = count != 0;
    if (!is_forward) count = closed_chain(half_edges, ends, begins);
    if (count == 0) return false;
    Rim& rim = rims.emplace_back(scratch);
    rim.is_closed = true;
    rim.half_edges.assign(half_edges.begin(),
                          half_edges.begin() + static_cast<std::ptrdiff_t>(count));
    if (!is_forward) std::reverse(rim.half_edges.begin() + 1, rim.half_edges.end());
    half_edges = half_edges.subspan(count);
  }
  return true;
}

}  // namespace

ScratchVector<Rim> chain_rims(std::span<const Index> half_edges, const Surface& surface,
                              ScratchMemory& scratch) {
  ScratchVector<Rim> rims(&scratch);
  if (chain_in_order(half_edges, surface, scratch, rims)) return rims;
  rims.clear();
  Leaving leaving(half_edges, surface, scratch);
  // All chains together are as long as the input, so they are written in one array first.
  ScratchVector<Index> chain(&scratch);
  chain.reserve(half_edges.size());
  const auto follow = [&](Index start) {
    chain.clear();
    Index point = start;
    for (Index h = leaving.take(point); h != kNone; h = leaving.take(point)) {
      chain.push_back(h);
      point = surface.corner_point[Surface::next(h)];
    }
    if (chain.empty()) return;
    Rim& rim = rims.emplace_back(scratch);
    rim.half_edges.assign(chain.begin(), chain.end());
    rim.is_closed = point == start;
  };
  for (const Index h : half_edges)  // open chains first, then closed ones
    if (!leaving.is_entered(surface.corner_point[h])) follow(surface.corner_point[h]);
  for (const Index h : half_edges) follow(surface.corner_point[h]);
  return rims;
}

ScratchVector<Rim> chain_rims(std::span<const Index> half_edges,
                              std::span<const std::array<Index, 2>> following,
                              const Surface& surface, ScratchMemory& scratch) {
  if (following.empty()) return chain_rims(half_edges, surface, scratch);
  Leaving leaving(half_edges, surface, scratch);
  for (const auto& [half_edge, next] : following) leaving.take_half_edge(next);
  // By half-edge, ascending: the one that follows it, if any.
  ScratchVector<std::array<Index, 2>> links(following.begin(), following.end(), &scratch);
  links.reserve(half_edges.size());
  const auto is_linked = [&](Index h) {
    const auto at = std::lower_bound(following.begin(), following.end(), std::array{h, Index{0}});
    return at != following.end() && (*at)[0] == h;
  };
  for (const Index h : half_edges)
    if (!is_linked(h))
      if (const Index next = leaving.take(surface.corner_point[Surface::next(h)]); next != kNone)
        links.push_back({h, next});
  std::sort(links.begin(), links.end());
  ScratchVector<Index> followers(&scratch);
  for (const auto& link : links) followers.push_back(link[1]);
  std::sort(followers.begin(), followers.end());

  ScratchVector<Rim> rims(&scratch);
  ScratchVector<bool> is_used(links.size(), false, &scratch);
  const auto link_of = [&](Index h) {
    return static_cast<std::size_t>(
        std::lower_bound(links.begin(), links.end(), std::array{h, Index{0}}) - links.begin());
  };
  const auto follow = [&](Index first) {
    Rim& rim = rims.emplace_back(scratch);
    for (Index h = first;;) {
      rim.half_edges.push_back(h);
      const std::size_t link = link_of(h);
      if (link == links.size() || links[link][0] != h) return;
      is_used[link] = true;
      h = links[link][1];
      if (h != first) continue;
      rim.is_closed = true;
      return;
    }
  };
  for (const Index h : half_edges)  // open chains first, then closed ones
    if (!std::binary_search(followers.begin(), followers.end(), h)) follow(h);
  for (std::size_t i = 0; i < links.size(); ++i)
    if (!is_used[i]) follow(links[i][0]);
  return rims;
}

}  // namespace sunder::tear
