#include "tear/suture/suture.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "core/operation/internal/check_ranges.h"
#include "core/operation/internal/describe_operations.h"
#include "tear/weld/choose_lips.h"

namespace sunder::tear {
namespace {

/// Points of two lips that lie on one another. At the tip of a wound they are one.
struct PointsAcross {
  Index left = kNone, right = kNone;

  auto operator<=>(const PointsAcross&) const = default;
};

/// An edge of a wound, along its left lip.
struct WoundEdge {
  PointsAcross from, to;
  Index mirrored = kNone;  ///< The index of the same edge along the other lip.

  [[nodiscard]] bool is_before(const WoundEdge& other) const { return from < other.from; }
};

/// Both directions of the edges that are chosen, by their beginnings.
ScratchVector<WoundEdge> find_edges(const Suture& suture, const Workpiece& work) {
  ScratchMemory& scratch = work.editor.scratch();
  const ScratchVector<Lip> lips = find_lips(work.editor);
  const ScratchVector<LipOverlap> overlaps = find_overlaps(lips, scratch);
  const ScratchVector<bool> is_chosen =
      choose_lips({suture.places, suture.reach}, lips, overlaps, work);
  ScratchVector<WoundEdge> edges(&scratch);
  for (const LipOverlap& of : overlaps) {
    if (!of.is_whole || !is_chosen[of.a] || !is_chosen[of.b]) continue;
    const auto &a = lips[of.a].points, &b = lips[of.b].points;
    edges.push_back({{a[0], b[1]}, {a[1], b[0]}});
    edges.push_back({{b[0], a[1]}, {b[1], a[0]}});
  }
  std::sort(edges.begin(), edges.end(), [](const WoundEdge& a, const WoundEdge& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  for (Index i = 0; i < edges.size(); ++i) {
    const WoundEdge mirrored = {{edges[i].to.right, edges[i].to.left},
                                {edges[i].from.right, edges[i].from.left}};
    auto at =
        std::lower_bound(edges.begin(), edges.end(), mirrored,
                         [](const WoundEdge& a, const WoundEdge& b) { return a.is_before(b); });
    while (at->to != mirrored.to) ++at;
    edges[i].mirrored = static_cast<Index>(at - edges.begin());
  }
  return edges;
}

/// The edges of a wound in a row, each of which begins where the one before ends.
class WoundChains {
 public:
  explicit WoundChains(const ScratchVector<WoundEdge>& edges)
      : edges_(edges), is_done_(edges.size(), false, edges.get_allocator()) {}

  /// Calls visit(chain), a list of pairs of points, for each wound; first those with ends, then
  /// closed ones.
  template <class Visit>
  void for_each(Visit visit) {
    ScratchVector<bool> has_edge_before(edges_.size(), false, edges_.get_allocator());
    for (Index i = 0; i < edges_.size(); ++i)
      if (const Index next = after(i); next != kNone) has_edge_before[next] = true;
    for (const bool with_ends : {true, false})
      for (Index i = 0; i < edges_.size(); ++i)
        if (!is_done_[i] && !(with_ends && has_edge_before[i])) visit(chain_from(i));
  }

 private:
  /// The edge that goes on from the end of another one; kNone at the tip of a wound.
  [[nodiscard]] Index after(Index edge) const {
    const PointsAcross& end = edges_[edge].to;
    if (end.left == end.right) return kNone;
    const auto at = std::lower_bound(
        edges_.begin(), edges_.end(), end,
        [](const WoundEdge& of, const PointsAcross& points) { return of.from < points; });
    return at != edges_.end() && at->from == end ? static_cast<Index>(at - edges_.begin()) : kNone;
  }
  ScratchVector<PointsAcross> chain_from(Index edge) {
    ScratchVector<PointsAcross> chain(edges_.get_allocator());
    chain.push_back(edges_[edge].from);
    for (; edge != kNone && !is_done_[edge]; edge = after(edge)) {
      is_done_[edge] = is_done_[edges_[edge].mirrored] = true;
      chain.push_back(edges_[edge].to);
    }
    return chain;
  }

  const ScratchVector<WoundEdge>& edges_;
  ScratchVector<bool> is_done_;
};

/// The distance of each pair of a chain from its beginning, along the wound.
ScratchVector<double> lengths_along(const ScratchVector<PointsAcross>& chain,
                                    const Workpiece& work) {
  ScratchVector<double> lengths(chain.get_allocator());
  double length = 0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (i > 0) {
      const Vec3d before = work.posed.position(work.editor, chain[i - 1].left);
      length += norm(Vec3d(work.posed.position(work.editor, chain[i].left) - before));
    }
    lengths.push_back(length);
  }
  return lengths;
}

/// Divides a wound into parts of about the wanted spacing, and chooses in each of them the pair of
/// points that is nearest to its middle.
ScratchVector<PointsAcross> choose_pairs(const ScratchVector<PointsAcross>& chain,
                                         std::span<const double> lengths, double spacing) {
  constexpr double kMostParts = 1e15;
  const double whole = lengths.back();
  const double parts = std::clamp(std::round(whole / spacing), 1.0, kMostParts);
  ScratchVector<PointsAcross> chosen(chain.get_allocator());
  double part_of_last = -1, nearest = 0;
  const bool is_closed = chain.size() > 1 && chain.front() == chain.back();
  for (std::size_t i = is_closed ? 1 : 0; i < chain.size(); ++i) {
    if (chain[i].left == chain[i].right) continue;
    const double place = whole > 0 ? lengths[i] / whole * parts : 0;
    const double part = std::min(std::floor(place), parts - 1);
    const double off = std::abs(place - part - 0.5);
    if (part != part_of_last)
      chosen.push_back(chain[i]);
    else if (off < nearest)
      chosen.back() = chain[i];
    else
      continue;
    part_of_last = part;
    nearest = off;
  }
  return chosen;
}

}  // namespace

Status validate_suture(const Suture& suture) {
  if (Status status = ChosenWounds{suture.places, suture.reach}.validate("sew"); !status)
    return status;
  return check_ranges(suture);
}

void tie_threads(const Suture& suture, const Workpiece& work, Outcome& outcome) {
  const ScratchVector<WoundEdge> edges = find_edges(suture, work);
  WoundChains(edges).for_each([&](const ScratchVector<PointsAcross>& chain) {
    const ScratchVector<double> lengths = lengths_along(chain, work);
    const ScratchVector<PointsAcross> pairs = choose_pairs(chain, lengths, suture.spacing);
    if (pairs.empty()) return;
    work.editor.room.make_for_threads(pairs.size());
    for (const PointsAcross& pair : pairs)
      work.editor.connectivity.append_thread(
          {pair.left, pair.right, suture.stiffness, suture.tension, suture.strength});
    ++outcome.report.runs;
    outcome.report.length_posed += lengths.back();
  });
}

}  // namespace sunder::tear
