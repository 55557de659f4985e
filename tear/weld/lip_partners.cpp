#include "tear/weld/lip_partners.h"

#include <algorithm>
#include <cmath>

#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

using PlaceOnLine = std::array<double, 2>;

PlaceOnLine way_between(const PlaceOnLine& a, const PlaceOnLine& b) {
  return {b[0] - a[0], b[1] - a[1]};
}
double inner_product_of(const PlaceOnLine& a, const PlaceOnLine& b) {
  return a[0] * b[0] + a[1] * b[1];
}
double cross_product_of(const PlaceOnLine& a, const PlaceOnLine& b) {
  return a[0] * b[1] - a[1] * b[0];
}
bool is_one_place_on_line(const PlaceOnLine& a, const PlaceOnLine& b) {
  return std::abs(a[0] - b[0]) <= kWeldBarycentric && std::abs(a[1] - b[1]) <= kWeldBarycentric;
}
double length_on_line(const Lip& lip) {
  const PlaceOnLine along = way_between(lip.from, lip.to);
  return std::sqrt(inner_product_of(along, along));
}

/// Whether two lips lie on one another, in opposite directions, in more than a point.
bool lie_on_one_another(const Lip& a, const Lip& b) {
  const PlaceOnLine along = way_between(a.from, a.to), back = way_between(b.from, b.to);
  if (!(inner_product_of(along, back) < 0)) return false;
  const double size = length_on_line(a);
  const auto distance = [&](const PlaceOnLine& place) {
    return std::abs(cross_product_of(along, way_between(a.from, place))) / size;
  };
  if (!(size > 0) || distance(b.from) > kWeldBarycentric || distance(b.to) > kWeldBarycentric)
    return false;
  const double low = std::max(0.0, share_of(b.to, a)), high = std::min(1.0, share_of(b.from, a));
  return (high - low) * size > 2 * kWeldBarycentric;
}

double low_end(const Lip& lip) { return std::min(lip.from[0], lip.to[0]); }
double high_end(const Lip& lip) { return std::max(lip.from[0], lip.to[0]); }

/// Lips of a line without a partner, by their low ends.
ScratchVector<std::size_t> without_partner(std::span<const Lip> lips, std::size_t begin,
                                           std::size_t end, const ScratchVector<bool>& has_partner,
                                           ScratchMemory& scratch) {
  ScratchVector<std::size_t> left(&scratch);
  for (std::size_t i = begin; i < end; ++i)
    if (!has_partner[i]) left.push_back(i);
  std::sort(left.begin(), left.end(), [&](std::size_t i, std::size_t k) {
    const double a = low_end(lips[i]), b = low_end(lips[k]);
    return a != b ? a < b : i < k;
  });
  return left;
}

/// Calls visit(lip, other) for pairs whose first coordinates overlap.
template <class Visit>
void for_each_near_pair(std::span<const Lip> lips, const ScratchVector<std::size_t>& by_low_end,
                        Visit visit) {
  for (std::size_t n = 0; n < by_low_end.size(); ++n) {
    const double high = high_end(lips[by_low_end[n]]) + kWeldBarycentric;
    for (std::size_t m = n + 1; m < by_low_end.size() && low_end(lips[by_low_end[m]]) <= high; ++m)
      visit(by_low_end[n], by_low_end[m]);
  }
}

/// The lip with exactly the ends of another one, in reverse; `end` if there is none.
std::size_t find_exact_partner(std::span<const Lip> lips, std::size_t of, std::size_t begin,
                               std::size_t end) {
  const auto before = [&](const Lip& a, const std::array<PlaceOnLine, 2>& ends) {
    return std::array{a.from, a.to} < ends;
  };
  const std::array<PlaceOnLine, 2> wanted = {lips[of].to, lips[of].from};
  const auto at = std::lower_bound(lips.begin() + std::ptrdiff_t(begin),
                                   lips.begin() + std::ptrdiff_t(end), wanted, before);
  const auto found = static_cast<std::size_t>(at - lips.begin());
  return found < end && std::array{lips[found].from, lips[found].to} == wanted ? found : end;
}

}  // namespace

double share_of(const std::array<double, 2>& place, const Lip& lip) {
  const PlaceOnLine along = way_between(lip.from, lip.to);
  return inner_product_of(along, way_between(lip.from, place)) / inner_product_of(along, along);
}

void add_shares_between(const Lip& lip, const Lip& other, ScratchVector<double>& shares) {
  const double least = kWeldBarycentric / length_on_line(lip);
  for (const PlaceOnLine& place : {other.from, other.to}) {
    const double share = share_of(place, lip);
    if (share > least && share < 1 - least) shares.push_back(share);
  }
  std::sort(shares.begin(), shares.end(), std::greater<>());
  const auto is_repeated = [&](double a, double b) { return a - b <= least; };
  shares.erase(std::unique(shares.begin(), shares.end(), is_repeated), shares.end());
}

ScratchVector<LipOverlap> find_overlaps(std::span<const Lip> lips, ScratchMemory& scratch) {
  ScratchVector<LipOverlap> found(&scratch);
  ScratchVector<bool> has_partner(lips.size(), false, &scratch);
  const auto add = [&](std::size_t a, std::size_t b, bool is_whole) {
    found.push_back({static_cast<Index>(a), static_cast<Index>(b), is_whole});
    if (is_whole) has_partner[a] = has_partner[b] = true;
  };
  for (std::size_t begin = 0, end = 0; begin < lips.size(); begin = end) {
    while (end < lips.size() && lips[end].line == lips[begin].line) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      if (has_partner[i]) continue;
      const std::size_t partner = find_exact_partner(lips, i, begin, end);
      if (partner < end && partner > i && !has_partner[partner]) add(i, partner, true);
    }
    // What is left was crossed by other wounds, or is of a gap.
    const ScratchVector<std::size_t> left = without_partner(lips, begin, end, has_partner, scratch);
    for_each_near_pair(lips, left, [&](std::size_t i, std::size_t k) {
      if (!has_partner[i] && !has_partner[k] && is_one_place_on_line(lips[i].from, lips[k].to) &&
          is_one_place_on_line(lips[i].to, lips[k].from))
        add(std::min(i, k), std::max(i, k), true);
    });
    for_each_near_pair(lips, left, [&](std::size_t i, std::size_t k) {
      if (!has_partner[i] && !has_partner[k] &&
          lie_on_one_another(lips[std::min(i, k)], lips[std::max(i, k)]))
        add(std::min(i, k), std::max(i, k), false);
    });
  }
  std::sort(found.begin(), found.end(), [](const LipOverlap& a, const LipOverlap& b) {
    return std::array{a.a, a.b} < std::array{b.a, b.b};
  });
  return found;
}

}  // namespace sunder::tear
