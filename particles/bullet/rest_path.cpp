#include "particles/bullet/rest_path.h"

#include <algorithm>
#include <numeric>

namespace sunder::particles {

Status RestPath::evaluate(const ParticleSet& set, const ModelPose& pose,
                          const Affine3d& world_from_model, Columns& places) {
  const Index count = set.particle_count();
  if (all_.size() != count) {
    rests_.resize(count);
    all_.resize(count);
    std::iota(all_.begin(), all_.end(), Index{0});
  }
  if (Status status = set.rest(pose, all_, rests_); !status) return status;
  places.resize(3, count);
  for (Index i = 0; i < count; ++i) places.col(i) = world_from_model * rests_[i].place;
  return {};
}

void RestPath::set_target(const Columns& target) {
  target_ = target;
  moves_ = (target_.array() != places_.array()).any();
}

void RestPath::begin(double seconds, double substep) {
  remaining_ = seconds + std::min(remaining_, substep);
}

void RestPath::jump() {
  places_ = target_;
  remaining_ = 0;
  moves_ = false;
}

double RestPath::part_of_way(double seconds) const {
  return remaining_ <= 0 || !moves_ ? 0.0 : seconds < remaining_ ? seconds / remaining_ : 1.0;
}

void RestPath::advance(double seconds) {
  if (const double part = part_of_way(seconds); part >= 1) {
    places_ = target_;
    moves_ = false;
  } else if (part > 0) {
    places_ += part * (target_ - places_);
  }
  remaining_ = std::max(0.0, remaining_ - seconds);
}

}  // namespace sunder::particles
