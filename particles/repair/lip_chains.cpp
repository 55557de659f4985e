#include "particles/repair/lip_chains.h"

#include <algorithm>
#include <limits>

#include "core/internal/ordered.h"

namespace sunder::particles {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

/// Walks along the lips of a tear.
class LipWalk {
 public:
  ///
  /// @param limit  length of border beyond the given points after which a chain ends, metres.
  LipWalk(const LipBorder& border, Structure& structure, Index tear, float limit)
      : border_(border),
        points_(structure.points),
        tear_(tear),
        limit_(limit),
        given_(structure.scratch.given),
        seen_(structure.scratch.seen) {}

  /// The chain of a point that is on a lip.
  LipChain chain_of(Index start) {
    LipChain chain;
    chain.side = side_ = points_.lip_points[start].side;
    const First first = walk_back(start);
    const float along = walk_forward(first.point, chain.places);
    chain.front.distance = chain.back.distance = kNever;
    if (!first.is_circle) {
      chain.front = end_at(first.point, false);
      chain.back = end_at(chain.places.back().point, true);
    }
    const float before = chain.front.distance, after = chain.back.distance;
    chain.length = before + along + after;
    for (LipChain::Place& place : chain.places)
      place.to_tip = std::min(place.along + before, along - place.along + after);
    return chain;
  }

 private:
  struct First {
    Index point;
    bool is_circle;
  };

  /// The next point, forward as the half-edges of the border point, or back.
  [[nodiscard]] Index step(Index point, bool forward) const {
    return forward ? border_.next(point) : border_.previous(point);
  }
  [[nodiscard]] bool is_lip(Index point) const {
    const LipPoint& lip = points_.lip_points[point];
    return lip.tear == tear_ && lip.side == side_;
  }
  [[nodiscard]] float between(Index a, Index b) const {
    return norm(points_.positions[b] - points_.positions[a]);
  }

  /// The first point of a chain; the start itself if the chain is closed. Where a border touches
  /// itself, the way back may circle without passing the start: then any of its points.
  [[nodiscard]] First walk_back(Index start) const {
    Index first = start;
    float beyond = 0;  // the points given
    Index steps = 0;
    for (Index at = step(start, false);
         at != kNone && !seen_.has(at) && is_lip(at) && beyond < limit_ && steps < points_.count();
         at = step(at, false), ++steps) {
      if (at == start) return {first, true};
      beyond = given_.has(at) ? 0 : beyond + between(first, at);
      first = at;
    }
    return {first, false};
  }

  /// Appends the places of a chain from its first point on. @return the distance from there to the
  /// last one.
  float walk_forward(Index first, std::vector<LipChain::Place>& places) {
    float along = 0, beyond = 0;
    for (Index at = first;;) {
      places.push_back({at, along, kNever});
      seen_.mark(at);
      const Index following = step(at, true);
      if (following == kNone || following == first || seen_.has(following)) return along;
      if (!is_lip(following) || beyond >= limit_) return along;
      const float length = between(at, following);
      along += length;
      beyond = given_.has(following) ? 0 : beyond + length;
      at = following;
    }
  }

  /// The end of a lip; `other` is the end point of the other lip. The distance to the tip is half
  /// of the way around it to the other lip.
  [[nodiscard]] LipChain::End end_at(Index end, bool forward) const {
    float walked = 0;
    Index first = kNone;
    Index steps = 0;
    for (Index at = end; walked <= 2 * limit_ && steps < points_.count(); ++steps) {
      const Index following = step(at, forward);
      if (following == kNone || following == end) break;
      walked += between(at, following);
      const LipPoint& lip = points_.lip_points[following];
      if (lip.tear == tear_ && lip.side != side_) {
        // At a tip there is one point between the lips; elsewhere the way leads along other
        // borders.
        if (at != first) return {kNone, kNone, 0.5f * walked};
        return {first, following, 0.5f * walked};
      }
      if (first == kNone) first = following;
      at = following;
    }
    return {kNone, kNone, kNever};
  }

  const LipBorder& border_;
  const PointTable& points_;
  Index tear_;
  float limit_;
  const Marks& given_;
  Marks& seen_;
  Side side_ = Side::left;
};

}  // namespace

std::vector<LipChain> find_lip_chains(const LipBorder& border, Structure& structure, Index tear,
                                      std::span<const Index> points) {
  Marks &given = structure.scratch.given, &seen = structure.scratch.seen;
  given.begin(structure.points.count());
  seen.begin(structure.points.count());
  for (const Index point : points) given.mark(point);
  LipWalk walk(border, structure, tear, static_cast<float>(structure.report.range));
  std::vector<LipChain> chains;
  for (const Index start : points)
    if (!seen.has(start)) chains.push_back(walk.chain_of(start));
  const auto chain_that_ends_at = [&](Index point) {
    const auto found = std::ranges::find_if(chains, [&](const LipChain& chain) {
      return chain.places.front().point == point || chain.places.back().point == point;
    });
    return found == chains.end() ? kNone : static_cast<Index>(found - chains.begin());
  };
  for (LipChain& chain : chains)
    for (LipChain::End* const end : {&chain.front, &chain.back})
      if (end->other != kNone) end->other = chain_that_ends_at(end->other);
  return chains;
}

}  // namespace sunder::particles
