#include "particles/motion/hold_list.h"

#include <algorithm>
#include <cmath>

namespace sunder::particles {

HoldId HoldList::add_particle(const ParticleSet& set, Index particle, const Vec3d& target,
                              double stiffness) {
  Hold& hold = holds_.emplace_back();
  hold.id = next_++;
  hold.particle = particle;
  hold.serial = set.serial(particle);
  hold.target = target;
  hold.stiffness = stiffness;
  const HoldId id = hold.id;
  follow(set);
  return id;
}

HoldId HoldList::add_point(const ParticleSet& set, Index point, const Vec3d& target,
                           double stiffness) {
  Hold& hold = holds_.emplace_back();
  hold.id = next_++;
  hold.point = point;
  hold.target = target;
  hold.stiffness = stiffness;
  const HoldId id = hold.id;
  follow(set);
  return id;
}

bool HoldList::move(HoldId id, const Vec3d& target) {
  for (Hold& hold : holds_)
    if (hold.id == id) {
      hold.target = target;
      return true;
    }
  return false;
}

bool HoldList::remove(HoldId id, ParticleInfluences& whom) {
  const auto at =
      std::find_if(holds_.begin(), holds_.end(), [&](const Hold& hold) { return hold.id == id; });
  if (at == holds_.end()) return false;
  whom = at->whom;
  holds_.erase(at);
  return true;
}

bool HoldList::is_there(const Hold& hold, const ParticleSet& set) {
  if (hold.point != kNone)
    return hold.point < set.point_count() && set.influences()[hold.point].weights[0] > 0;
  return hold.particle < set.particle_count() && set.serial(hold.particle) == hold.serial;
}

void HoldList::find_held(const ParticleSet& set, Hold& hold) {
  if (hold.point != kNone)
    hold.whom = set.influences()[hold.point];
  else
    hold.whom = {{hold.particle}, {1.0f}};
}

bool HoldList::find_held(const ParticleSet& set) {
  for (Hold& hold : holds_) {
    if (!is_there(hold, set)) return false;
    find_held(set, hold);
  }
  return true;
}

void HoldList::follow(const ParticleSet& set) {
  std::erase_if(holds_, [&](const Hold& hold) { return !is_there(hold, set); });
  for (Hold& hold : holds_) {
    hold.epoch = 0;
    find_held(set, hold);
  }
}

void HoldList::begin_step(const TornModel& model, const ModelPose& pose, const RestMotion& rests,
                          std::span<const double> masses, EpochPose& poses, Motion& motion,
                          std::vector<PointPull>& pulls) {
  for (Hold& hold : holds_) {
    PointPull& pull = pulls.emplace_back();
    double mass = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      pull.particles[k] = hold.whom.particles[k];
      pull.weights[k] = double{hold.whom.weights[k]};
      if (pull.weights[k] > 0) mass += pull.weights[k] * masses[pull.particles[k]];
    }
    pull.stiffness = hold.stiffness * mass;
    pull.frequency = std::sqrt(hold.stiffness);
    if (hold.point == kNone) {
      hold.rest = rests.place(hold.particle);
    } else if (hold.epoch != rests.epoch()) {
      hold.rest = poses.at(model, pose, rests.epoch()).place(model, hold.point);
      hold.epoch = rests.epoch();
    }
    pull.target = hold.target - hold.rest;
    if (pull.target != hold.last) {
      hold.last = pull.target;
      for (std::size_t k = 0; k < 4; ++k)
        if (pull.weights[k] > 0) motion.wake(pull.particles[k]);
    }
    for (std::size_t k = 0; k < 4; ++k)
      if (pull.weights[k] > 0) motion.bound[pull.particles[k]] = 1;
  }
}

}  // namespace sunder::particles
