#include "particles/contact/contact.h"

#include <algorithm>
#include <cmath>

namespace sunder::particles {
namespace {

constexpr int kSweeps = 48, kVelocitySweeps = 4;
constexpr double kTolerance = 1e-3;  // ranges
constexpr double kMargin = 0.25;     // ranges from a collider within which a point may be pushed in by its neighbours' contacts
/// A member is at most two ranges from the centroid of all. For a pose that changes no length, RestMotion::size() is 3^0.5.
constexpr double kReach = 1.2;

Vec3d sum_of(const ParticleInfluences& whom, const std::vector<Vec3d>& values) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < 4 && whom.weights[k] > 0; ++k) sum += double{whom.weights[k]} * values[whom.particles[k]];
  return sum;
}

void add_to(const ParticleInfluences& whom, double squares, const Vec3d& change, std::vector<Vec3d>& values) {
  for (std::size_t k = 0; k < 4 && whom.weights[k] > 0; ++k)
    values[whom.particles[k]] += (double{whom.weights[k]} / squares) * change;
}

Vec3d rest_velocity(const ParticleInfluences& whom, const RestMotion& rests) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < 4 && whom.weights[k] > 0; ++k) sum += double{whom.weights[k]} * rests.velocity(whom.particles[k]);
  return sum;
}

}  // namespace

void Contact::set(std::span<const Collider> colliders) {
  colliders_.assign(colliders.begin(), colliders.end());
  before_ = colliders_;
  is_changed_ = true;
}

void Contact::move(std::uint32_t collider, const Vec3d& place, const Quatd& turn) {
  Collider& moved = colliders_[collider];
  if (moved.place == place && moved.turn.coeffs() == turn.coeffs()) return;
  moved.place = place;
  moved.turn = turn.normalized();
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
  return (place - (before.place + before.turn * (now.turn.conjugate() * (place - now.place)))) / seconds;
}

void Contact::find(const World& world, const Motion& motion) {
  touches_.clear();
  double most = 0;
  for (Index p = 0; p < motion.count(); ++p) most = std::max(most, motion.displacements[p].squaredNorm());
  most = std::sqrt(most);
  const bool is_quiet = !is_changed_ && !world.is_posed;
  for (Index p = 0; p < motion.count(); ++p) {
    const double range = world.set.range(p), reach = kReach * world.rests.size(p) * range + most;
    if (is_quiet && motion.awake[p] == 0) {
      const auto of_p = world.graph.of(p);
      if (std::none_of(of_p.begin(), of_p.end(), [&](const Spring& spring) { return motion.awake[spring.other] != 0; })) continue;
    }
    const ContactPoints::Points* points = nullptr;
    for (std::uint32_t c = 0; c < colliders_.size(); ++c) {
      if (distance_to(colliders_[c], world.rests.place(p)).distance > reach) continue;
      if (points == nullptr) {
        world.places.set_pose(world.model, world.pose, world.rests.epoch());
        points = &points_.of(world.set, world.model, world.places, world.rests.epoch(), p);
      }
      for (Index i = 0; i < points->count; ++i) {
        const ParticleInfluences& whom = world.set.influences()[points->points[i]];
        const Vec3d place = points->places[i] + sum_of(whom, motion.displacements);
        if (distance_to(colliders_[c], place).distance > kMargin * range) continue;
        Touch& touch = touches_.emplace_back();
        touch.point = points->points[i];
        touch.collider = c;
        touch.rest = points->places[i];
        touch.whom = whom;
        for (const float weight : whom.weights) touch.squares += double{weight} * double{weight};
        touch.tolerance = kTolerance * range;
      }
    }
  }
}

double Contact::push_once(const World& world, Motion& motion) {
  double deepest = 0;
  for (Touch& touch : touches_) {
    const Vec3d moved = sum_of(touch.whom, motion.displacements);
    const SurfaceDistance at = distance_to(colliders_[touch.collider], touch.rest + moved);
    if (!(at.distance < 0)) continue;
    const bool is_awake =
        std::any_of(touch.whom.particles.begin(), touch.whom.particles.end(),
                    [&, k = std::size_t{0}](Index p) mutable { return touch.whom.weights[k++] > 0 && motion.awake[p] != 0; });
    if (!is_awake && -at.distance < 2 * touch.tolerance) continue;  // it fell asleep so
    deepest = std::max(deepest, -at.distance / touch.tolerance);
    Vec3d by = -at.distance * at.normal;
    touch.normal = at.normal;
    if (const double friction = colliders_[touch.collider].friction; friction > 0) {
      // What it slid along the collider in this step is taken back, as far as the push allows.
      const Vec3d velocity = rest_velocity(touch.whom, world.rests) - velocity_of(touch, touch.rest + moved, world.seconds);
      Vec3d slid = moved - sum_of(touch.whom, motion.starts) + world.seconds * velocity;
      slid -= slid.dot(at.normal) * at.normal;
      const double length = slid.norm();
      const double back = std::clamp(friction * (touch.depth - at.distance) - touch.dragged, 0.0, length);
      if (length > 0) by -= back / length * slid;
      touch.dragged += back;
    }
    touch.depth += -at.distance;
    add_to(touch.whom, touch.squares, by, motion.displacements);
    for (std::size_t k = 0; k < 4 && touch.whom.weights[k] > 0; ++k) {
      const Index p = touch.whom.particles[k];
      if (motion.awake[p] == 0) motion.wake(p);
      motion.touched[p] = motion.bound[p] = 1;
    }
  }
  return deepest;
}

void Contact::slow_down(const World& world, Motion& motion) {
  // Who was pushed back to where the step began is at rest, whatever pulled it away meanwhile. The other way round, who was pushed
  // far in a short step has not got that velocity: the lesser counts.
  if (world.seconds > 0)
    for (Index p = 0; p < motion.count(); ++p) {
      if (motion.touched[p] == 0 || motion.awake[p] == 0) continue;
      const Vec3d mean = (motion.displacements[p] - motion.starts[p]) / world.seconds;
      if (mean.squaredNorm() < motion.velocities[p].squaredNorm()) motion.velocities[p] = mean;
    }
  for (int sweep = 0; sweep < kVelocitySweeps; ++sweep)
    for (const Touch& touch : touches_) {
      if (!(touch.depth > 0)) continue;
      const Vec3d place = touch.rest + sum_of(touch.whom, motion.displacements);
      const Vec3d velocity =
          sum_of(touch.whom, motion.velocities) + rest_velocity(touch.whom, world.rests) - velocity_of(touch, place, world.seconds);
      const double into = -velocity.dot(touch.normal);
      if (!(into > 0)) continue;
      Vec3d along = velocity + into * touch.normal;
      const double length = along.norm(), most = colliders_[touch.collider].friction * into;
      if (length > most) along *= most / length;
      add_to(touch.whom, touch.squares, into * touch.normal - along, motion.velocities);
    }
}

ContactReport Contact::push_out(const World& world, Motion& motion) {
  ContactReport report;
  if (colliders_.empty() || (!is_changed_ && !world.is_posed && motion.awake_count == 0)) return report;
  find(world, motion);
  if (touches_.empty()) return report;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    if (push_once(world, motion) <= 1) break;
  slow_down(world, motion);
  for (const Touch& touch : touches_) {
    if (touch.depth > 0) ++report.points;
    const Vec3d place = touch.rest + sum_of(touch.whom, motion.displacements);
    report.deepest = std::max(report.deepest, -distance_to(colliders_[touch.collider], place).distance);
  }
  return report;
}

}  // namespace sunder::particles
