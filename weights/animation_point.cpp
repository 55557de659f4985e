#include "weights/internal/animation_point.h"

#include <algorithm>

#include "core/internal/ordered.h"

namespace sunder {

void AnimationPoint::add(double part, const Vec3d& position,
                         std::span<const Influence> influences) {
  if (part == 0.0) return;
  for (const Influence& influence : influences) {
    const double weight = part * static_cast<double>(influence.weight);
    add(influence.slot,
        {weight * position.x(), weight * position.y(), weight * position.z(), weight});
  }
}

void AnimationPoint::add(double part, const AnimationPoint& point) {
  if (part == 0.0) return;
  for (const Term& term : point.terms_) add(term.slot, part * term.q);
}

void AnimationPoint::add(std::uint32_t slot, const Vec4d& q) {
  // There are a few dozen terms at most, so a linear search is faster than any map.
  const auto same = std::find_if(terms_.begin(), terms_.end(),
                                 [&](const Term& term) { return term.slot == slot; });
  if (same == terms_.end())
    terms_.push_back({slot, q});
  else
    same->q += q;
}

Vec3d AnimationPoint::posed(std::span<const Affine3d> model_from_bind) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Term& term : terms_) sum += multiply(model_from_bind[term.slot].matrix(), term.q);
  return sum;
}

}  // namespace sunder
