#include "particles/contact/contact.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/clusters/influences.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// Maximum number of sweeps over the contacts of a step: over places, and over velocities.
constexpr int kPlaceSweeps = 48, kVelocitySweeps = 4;

Vec3d sum_of(const ParticleInfluences& whom, const std::vector<Vec3d>& values) {
  Vec3d sum = Vec3d::Zero();
  for_each_influence(whom, [&](Index p, double weight) { sum += weight * values[p]; });
  return sum;
}

void add_to(const ParticleInfluences& whom, double squares, const Vec3d& change,
            std::vector<Vec3d>& values) {
  for_each_influence(whom,
                     [&](Index p, double weight) { values[p] += (weight / squares) * change; });
}

Vec3d rest_velocity(const ParticleInfluences& whom, const RestMotion& rests) {
  Vec3d sum = Vec3d::Zero();
  for_each_influence(whom, [&](Index p, double weight) { sum += weight * rests.velocity(p); });
  return sum;
}

}  // namespace

void Contact::set(std::span<const Collider> colliders) {
  std::vector<Collider> now(colliders.begin(), colliders.end()), before = now;
  if (!now.empty()) points_.follow(particle_count_);
  colliders_ = std::move(now);
  before_ = std::move(before);
  is_changed_ = true;
}

void Contact::move(std::uint32_t collider, const Vec3d& place, const Quatd& turn) {
  Collider& moved = colliders_[collider];
  if (moved.place == place && moved.turn.coeffs() == turn.coeffs()) return;
  moved.place = place;
  moved.turn = normalized(turn);
  is_changed_ = true;
}

void Contact::end_step() {
  if (!is_changed_) return;
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    before_[i].place = colliders_[i].place;
    before_[i].turn = colliders_[i].turn;
  }
  is_changed_ = false;
}

Vec3d Contact::velocity_of(const Touch& touch, const Vec3d& place, double seconds) const {
  const Collider& now = colliders_[touch.collider];
  const Collider& before = before_[touch.collider];
  if (!(seconds > 0)) return Vec3d::Zero();
  return (place - (before.place + before.turn * (now.turn.conjugate() * (place - now.place)))) /
         seconds;
}

void Contact::find(const World& world, const Motion& motion) {
  touches_.clear();
  double most = 0;
  for (Index p = 0; p < motion.count(); ++p)
    most = std::max(most, squared_norm(motion.displacements[p]));
  most = std::sqrt(most);
  const bool is_quiet = !is_changed_ && !world.is_posed;
  const auto is_awake = [&](const Spring& spring) { return motion.awake[spring.other] != 0; };
  for (Index p = 0; p < motion.count(); ++p) {
    if (is_quiet && motion.awake[p] == 0) {
      const auto of_p = world.graph.of(p);
      if (std::none_of(of_p.begin(), of_p.end(), is_awake)) continue;
    }
    find_near(world, motion, p, kMemberRanges * world.rests.size(p) * world.set.range(p) + most);
  }
}

///
/// @param reach  largest distance of contact points from the particle's rest place, metres.
void Contact::find_near(const World& world, const Motion& motion, Index particle, double reach) {
  const double range = world.set.range(particle);
  const ContactPoints::Points* points = nullptr;
  for (Index c = 0; c < colliders_.size(); ++c) {
    if (distance_to(colliders_[c], world.rests.place(particle)).distance > reach) continue;
    if (points == nullptr) {
      const SurfacePose& pose = world.poses.at(world.model, world.pose, world.rests.epoch());
      points = &points_.of(world.set, world.model, pose, world.rests.epoch(), particle);
    }
    for (Index i = 0; i < points->count; ++i) add_touch(world, motion, *points, i, c, range);
  }
}

void Contact::add_touch(const World& world, const Motion& motion,
                        const ContactPoints::Points& points, Index i, Index collider,
                        double range) {
  const ParticleInfluences& whom = world.set.influences()[points.points[i]];
  const Vec3d place = points.places[i] + sum_of(whom, motion.displacements);
  if (distance_to(colliders_[collider], place).distance > kContactMarginRanges * range) return;
  Touch& touch = touches_.emplace_back();
  touch.point = points.points[i];
  touch.collider = collider;
  touch.rest = points.places[i];
  touch.whom = whom;
  for (const float weight : whom.weights) touch.squares += double{weight} * double{weight};
  touch.tolerance = kContactDepthRanges * range;
}

/// The part of a point's sliding along its collider in this step that friction undoes, limited by
/// the push.
/// @param moved  displacement of the point.
/// @param at  its place in the collider.
Vec3d Contact::drag_back(const World& world, const Motion& motion, Touch& touch, const Vec3d& moved,
                         const SurfaceDistance& at) const {
  const double friction = colliders_[touch.collider].friction;
  if (!(friction > 0)) return Vec3d::Zero();
  const Vec3d velocity = rest_velocity(touch.whom, world.rests) -
                         velocity_of(touch, touch.rest + moved, world.seconds);
  Vec3d slid = moved - sum_of(touch.whom, motion.starts) + world.seconds * velocity;
  slid -= dot(slid, at.normal) * at.normal;
  const double length = norm(slid);
  const double back =
      std::clamp(friction * (touch.depth - at.distance) - touch.dragged, 0.0, length);
  touch.dragged += back;
  return length > 0 ? Vec3d(back / length * slid) : Vec3d(Vec3d::Zero());
}

///
/// @return the largest depth of a point, in tolerances.
double Contact::push_once(const World& world, Motion& motion) {
  double deepest = 0;
  for (Touch& touch : touches_) {
    const Vec3d moved = sum_of(touch.whom, motion.displacements);
    const SurfaceDistance at = distance_to(colliders_[touch.collider], touch.rest + moved);
    if (!(at.distance < 0)) continue;
    bool is_awake = false, is_restless = false;
    for_each_influence(touch.whom, [&](Index p, double) {
      is_awake |= motion.awake[p] != 0;
      is_restless |= motion.awake[p] != 0 && motion.quiet.seconds[p] < kQuietSeconds;
    });
    if (!is_restless && -at.distance < 2 * touch.tolerance) continue;  // it may sleep so
    deepest = std::max(deepest, -at.distance / touch.tolerance);
    touch.normal = at.normal;
    const Vec3d by = -at.distance * at.normal - drag_back(world, motion, touch, moved, at);
    touch.depth += -at.distance;
    add_to(touch.whom, touch.squares, by, motion.displacements);
    for_each_influence(touch.whom, [&](Index p, double) {
      if (motion.awake[p] == 0) is_awake ? motion.rouse(p) : motion.wake(p);
      motion.touched[p] = motion.bound[p] = 1;
    });
  }
  return deepest;
}

void Contact::slow_down(const World& world, Motion& motion) {
  // A particle that was pushed back to its place at the beginning of the step is at rest, whatever
  // pulled it away meanwhile. Conversely, a particle that was pushed far in a short step does not
  // get that velocity. The smaller of the two applies.
  if (world.seconds > 0)
    for (Index p = 0; p < motion.count(); ++p) {
      if (motion.touched[p] == 0 || motion.awake[p] == 0) continue;
      const Vec3d mean = (motion.displacements[p] - motion.starts[p]) / world.seconds;
      if (squared_norm(mean) < squared_norm(motion.velocities[p])) motion.velocities[p] = mean;
    }
  for (int sweep = 0; sweep < kVelocitySweeps; ++sweep)
    for (const Touch& touch : touches_) {
      if (!(touch.depth > 0)) continue;
      const Vec3d place = touch.rest + sum_of(touch.whom, motion.displacements);
      const Vec3d velocity = sum_of(touch.whom, motion.velocities) +
                             rest_velocity(touch.whom, world.rests) -
                             velocity_of(touch, place, world.seconds);
      const double into = -dot(velocity, touch.normal);
      if (!(into > 0)) continue;
      Vec3d along = velocity + into * touch.normal;
      const double length = norm(along), most = colliders_[touch.collider].friction * into;
      if (length > most) along *= most / length;
      add_to(touch.whom, touch.squares, into * touch.normal - along, motion.velocities);
    }
}

void Contact::push_out(const World& world, Motion& motion) {
  report_ = {};
  if (colliders_.empty() || (!is_changed_ && !world.is_posed && motion.awake_count == 0)) return;
  find(world, motion);
  if (touches_.empty()) return;
  for (int sweep = 0; sweep < kPlaceSweeps; ++sweep)
    if (push_once(world, motion) <= 1) break;
  slow_down(world, motion);
  for (const Touch& touch : touches_) {
    if (touch.depth > 0) ++report_.points;
    const Vec3d place = touch.rest + sum_of(touch.whom, motion.displacements);
    report_.deepest =
        std::max(report_.deepest, -distance_to(colliders_[touch.collider], place).distance);
  }
}

}  // namespace sunder::particles
