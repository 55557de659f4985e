#include "particles/rupture/lip_from_tip.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/clusters/lip_border.h"
#include "particles/clusters/structure_of.h"
#include "particles/motion/lip_tension.h"

namespace sunder::particles {

LipFromTip::LipFromTip(const Tissue& tissue, std::span<const Index> tips, Index tip, Way way,
                       double longest)
    : tissue_(tissue) {
  const LipBorder border(tissue.model);
  const Surface& surface = tissue.model.surface();
  const std::vector<LipPoint>& lip_points = StructureOf::in(tissue.set).points.lip_points;
  Index at = tip;
  double distance = 0;
  bool has_begun = false;  // the end of a gap belongs to no lip
  // Edges without length may lead in a circle.
  while (distance < longest && !ends_at_tip_ && places_.size() < tissue.set.point_count()) {
    const Index half_edge = way == Way::forward ? border.leaving(at) : border.arriving(at);
    if (half_edge == kNone) break;
    const Index following =
        surface.corner_point[way == Way::forward ? Surface::next(half_edge) : half_edge];
    ends_at_tip_ = std::ranges::binary_search(tips, following);
    const bool is_lip = lip_points[following].tear != kNone;
    ends_at_border_ = has_begun && !is_lip && !ends_at_tip_;
    if (ends_at_border_) break;
    has_begun |= is_lip;
    distance += norm(Vec3d(tissue.position(following) - tissue.position(at)));
    places_.push_back({following, half_edge, distance});
    at = following;
  }
}

Vec3d LipFromTip::displacement(double distance) const {
  const auto after = std::ranges::lower_bound(places_, distance, {}, &Place::distance);
  if (after == places_.end()) return tissue_.displacement(places_.back().point);
  const Vec3d there = tissue_.displacement(after->point);
  if (after == places_.begin()) return there;
  const auto before = after - 1;
  const double t = (distance - before->distance) / (after->distance - before->distance);
  return tissue_.displacement(before->point) * (1 - t) + there * t;
}

Vec3d LipFromTip::inward(double begin, double end) const {
  Vec3d sum = Vec3d::Zero();
  double from = 0, weights = 0;
  for (const Place& place : places_) {
    const bool is_last = &place == &places_.back();
    const double first = std::max(from, begin), last = std::min(place.distance, end);
    from = place.distance;
    const double weight = is_last && !(weights > 0) ? 1.0 : std::sqrt(last) - std::sqrt(first);
    if (!(weight > 0)) continue;
    const LipEdge lip = edge_of(place);
    Vec3d turned = Vec3d::Zero();
    for (const Index point : lip.points)
      if (const Index owner = tissue_.set.owners()[point]; owner != kNone)
        turned += 0.5 * multiply(tissue_.rests.turn(owner), lip.inward.cast<double>());
    sum += weight * turned;
    weights += weight;
  }
  return weights > 0 ? Vec3d(sum / weights) : sum;
}

LipEdge LipFromTip::edge_of(const Place& place) const {
  const Surface& surface = tissue_.model.surface();
  const std::array<Index, 2> ends = {surface.corner_point[place.half_edge],
                                     surface.corner_point[Surface::next(place.half_edge)]};
  const Vec3d from = tissue_.position(ends[0]),
              edge = normalized(Vec3d(tissue_.position(ends[1]) - from)),
              apex = tissue_.position(surface.corner_point[Surface::previous(place.half_edge)]);
  const Vec3d to_apex = apex - from;
  const Vec3d inward = normalized(Vec3d(to_apex - dot(to_apex, edge) * edge));
  return {ends, inward.cast<float>()};
}

Vec3d LipFromTip::pull_of(const Place& place) const {
  const std::vector<PointFactors>& factors = StructureOf::in(tissue_.set).authored.of_points;
  const LipEdge lip = edge_of(place);
  Vec3d sum = Vec3d::Zero();
  for (const Index point : lip.points)
    if (const Index owner = tissue_.set.owners()[point]; owner != kNone)
      sum += 0.5 * multiply(tissue_.rests.turn(owner),
                            pull_at(lip, tissue_.set.positions(),
                                    {tissue_.tension, tissue_.added_tension, factors}, owner));
  return sum;
}

}  // namespace sunder::particles
