#include "particles/repair/lip_chains.h"

#include <limits>

namespace sunder::particles {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

/// Walks along a lip, forward as its border's half-edges point, or back.
class LipWalk {
 public:
  LipWalk(const LipBorder& border, const Structure& structure, Index tear, Side side)
      : border_(border), structure_(structure), tear_(tear), side_(side) {}

  [[nodiscard]] Index step(Index point, bool forward) const { return forward ? border_.next(point) : border_.previous(point); }
  [[nodiscard]] bool is_lip(Index point) const {
    const LipPoint& lip = structure_.lip_points[point];
    return lip.tear == tear_ && lip.side == side_;
  }
  [[nodiscard]] float between(Index a, Index b) const { return (structure_.positions[b] - structure_.positions[a]).norm(); }

  /// How far it is from an end of a lip to its tip: half of the way around that to the other lip.
  [[nodiscard]] float to_tip(Index end, bool forward, float limit) const {
    float walked = 0;
    for (Index at = end; walked <= 2 * limit;) {
      const Index following = step(at, forward);
      if (following == kNone || following == end) break;
      walked += between(at, following);
      const LipPoint& lip = structure_.lip_points[following];
      if (lip.tear == tear_ && lip.side != side_) return 0.5f * walked;
      at = following;
    }
    return kNever;
  }

 private:
  const LipBorder& border_;
  const Structure& structure_;
  Index tear_;
  Side side_;
};

}  // namespace

std::vector<LipChain> find_lip_chains(const LipBorder& border, const Structure& structure, Index tear,
                                      std::span<const Index> points, float limit, Marks& given, Marks& seen) {
  given.begin(structure.point_count());
  seen.begin(structure.point_count());
  for (const Index point : points) given.mark(point);
  std::vector<LipChain> chains;
  for (const Index start : points) {
    if (seen.has(start)) continue;
    LipChain& chain = chains.emplace_back();
    chain.side = structure.lip_points[start].side;
    const LipWalk walk(border, structure, tear, chain.side);
    Index first = start;
    float beyond = 0;  // what is given
    bool is_circle = false;
    for (Index at = walk.step(start, false); at != kNone && !seen.has(at) && walk.is_lip(at) && beyond < limit;
         at = walk.step(at, false)) {
      is_circle = at == start;
      if (is_circle) break;
      beyond = given.has(at) ? 0 : beyond + walk.between(first, at);
      first = at;
    }
    float along = 0;
    beyond = 0;
    for (Index at = first;;) {
      chain.places.push_back({at, along, kNever});
      seen.mark(at);
      const Index following = walk.step(at, true);
      if (following == kNone || following == first || seen.has(following) || !walk.is_lip(following) || beyond >= limit) break;
      const float step = walk.between(at, following);
      along += step;
      beyond = given.has(following) ? 0 : beyond + step;
      at = following;
    }
    float before = kNever, after = kNever;
    if (!is_circle) {
      before = walk.to_tip(first, false, limit);
      after = walk.to_tip(chain.places.back().point, true, limit);
    }
    chain.length = before + along + after;
    for (LipChain::Place& place : chain.places) place.to_tip = std::min(place.along + before, along - place.along + after);
  }
  return chains;
}

}  // namespace sunder::particles
