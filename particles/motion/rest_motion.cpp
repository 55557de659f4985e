#include "particles/motion/rest_motion.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include "core/internal/ordered.h"
#include "particles/internal/tolerances.h"
#include "particles/motion/turn_of.h"
#include "skinning/internal/same_bits.h"

namespace sunder::particles {
namespace {

Mat3d inverse_or_zero(const Mat3d& m) {
  const double size = norm(m), volume = determinant(m);
  if (!(std::abs(volume) > kFlatDeterminant * size * size * size)) return Mat3d::Zero();
  return inverse(m);
}

}  // namespace

Status RestMotion::begin(const ParticleSet& set, const ModelPose& pose) {
  if (Status status = set.rest(pose, {}, {}); !status) return status;
  decomposition_pose_ = pose_ = pose;
  std::vector<Index> all(set.particle_count());
  std::iota(all.begin(), all.end(), Index{0});
  follow(set, all);
  return {};
}

void RestMotion::follow(const ParticleSet& set, std::span<const Index> changed) {
  const Index count = set.particle_count();
  particles_.resize(count);
  for (std::vector<Index>* list : {&moved_, &carried_})
    std::erase_if(*list, [&](Index p) { return p >= count; });
  stale_.reserve(count);
  moved_.reserve(count);
  carried_.reserve(2 * std::size_t{count});  // for set_velocity()
  stale_.clear();
  evaluate(set, decomposition_pose_, changed);
  for (std::size_t i = 0; i < changed.size(); ++i)
    particles_[changed[i]].decomposition_from_bind = inverse_or_zero(rests_[i].linear);
  evaluate(set, pose_, changed);
  for (std::size_t i = 0; i < changed.size(); ++i) {
    Particle& particle = particles_[changed[i]];
    particle.place = rests_[i].place;
    const Mat3d relative = multiply(rests_[i].linear, particle.decomposition_from_bind);
    particle.size = norm(relative);
    turn_of(relative, particle.turn);
    particle.epoch = epoch_;
  }
}

void RestMotion::evaluate(const ParticleSet& set, const ModelPose& pose,
                          std::span<const Index> particles) {
  rests_.resize(particles.size());
  (void)set.rest(pose, particles, rests_);  // poses were checked
}

bool RestMotion::is_same(const ModelPose& pose) const {
  if (pose.model_from_bone.size() != pose_.model_from_bone.size() ||
      pose.morph_weights.size() != pose_.morph_weights.size())
    return false;
  for (std::size_t i = 0; i < pose.model_from_bone.size(); ++i)
    if (!has_same_bits(pose.model_from_bone[i], pose_.model_from_bone[i])) return false;
  return pose.morph_weights.empty() ||
         std::memcmp(pose.morph_weights.data(), pose_.morph_weights.data(),
                     pose.morph_weights.size() * sizeof(float)) == 0;
}

void RestMotion::stop_all() {
  for (const Index p : carried_) particles_[p].velocity.setZero();
  carried_.clear();
}

void RestMotion::begin_step(const ModelPose& pose) {
  stop_all();
  pose_ = pose;
  epoch_ += is_gap_ ? 2 : 1;
  is_gap_ = false;
}

void RestMotion::begin_still_step() { stop_all(); }

void RestMotion::skip_step() {
  stop_all();
  is_gap_ = true;
}

void RestMotion::update(const ParticleSet& set, std::span<const Index> particles, double seconds) {
  stale_.clear();
  moved_.clear();
  for (const Index p : particles)
    if (particles_[p].epoch != epoch_) stale_.push_back(p);
  if (stale_.empty()) return;
  evaluate(set, pose_, stale_);
  for (std::size_t i = 0; i < stale_.size(); ++i) {
    Particle& particle = particles_[stale_[i]];
    const Mat3d relative = multiply(rests_[i].linear, particle.decomposition_from_bind);
    Mat3d turn = particle.turn;
    turn_of(relative, turn);
    particle.size = norm(relative);
    if (particle.epoch + 1 == epoch_ &&
        (particle.place != rests_[i].place || particle.turn != turn)) {
      particle.shift = rests_[i].place - particle.place;
      particle.turn_of_step = multiply(turn, particle.turn.transpose());
      if (seconds > 0) {
        particle.velocity = particle.shift / seconds;
        carried_.push_back(stale_[i]);
      }
      moved_.push_back(stale_[i]);
    }
    particle.place = rests_[i].place;
    particle.turn = turn;
    particle.epoch = epoch_;
  }
}

}  // namespace sunder::particles
