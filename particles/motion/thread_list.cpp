#include "particles/motion/thread_list.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/clusters/structure_of.h"
#include "particles/internal/tolerances.h"
#include "particles/internal/vector_bytes.h"

namespace sunder::particles {
namespace {

void add_end(const ParticleInfluences& whom, double sign, PointPull& pull) {
  for (std::size_t k = 0; k < 4 && whom.weights[k] > 0; ++k) {
    std::size_t i = 0;
    while (pull.weights[i] != 0 && pull.particles[i] != whom.particles[k]) ++i;
    pull.particles[i] = whom.particles[k];
    pull.weights[i] += sign * double{whom.weights[k]};
    if (pull.weights[i] != 0) continue;
    // The ends move alike there: the last entry takes its place.
    std::size_t last = i;
    while (last + 1 < PointPull::kMost && pull.weights[last + 1] != 0) ++last;
    std::swap(pull.weights[i], pull.weights[last]);
    std::swap(pull.particles[i], pull.particles[last]);
  }
}

/// The mass with which the ends of a thread resist its pull.
double reduced_mass(const PointPull& pull, std::span<const double> masses) {
  double inverse = 0;
  for (std::size_t k = 0; k < PointPull::kMost && pull.weights[k] != 0; ++k)
    inverse += pull.weights[k] * pull.weights[k] / masses[pull.particles[k]];
  return 1 / inverse;
}

}  // namespace

Vec3d ThreadList::Thread::way(const Motion& motion) const {
  Vec3d way = rest;
  for (std::size_t k = 0; k < PointPull::kMost && pull.weights[k] != 0; ++k)
    way += pull.weights[k] * motion.displacements[pull.particles[k]];
  return way;
}

double ThreadList::Thread::newtons(double length) const {
  return of.stiffness * length + of.tension * std::min(1.0, length / least_length);
}

void ThreadList::wake(const Thread& thread, Motion& motion) {
  for (std::size_t k = 0; k < PointPull::kMost && thread.pull.weights[k] != 0; ++k)
    motion.wake(thread.pull.particles[k]);
}

bool ThreadList::is_awake(const Thread& thread, const Motion& motion) {
  for (std::size_t k = 0; k < PointPull::kMost && thread.pull.weights[k] != 0; ++k)
    if (motion.awake[thread.pull.particles[k]] != 0) return true;
  return false;
}

void ThreadList::find_held(const ParticleSet& set, Thread& thread) {
  thread.pull = {};
  const auto &left = set.influences()[thread.of.left], &right = set.influences()[thread.of.right];
  if (!(left.weights[0] > 0) || !(right.weights[0] > 0)) return;
  add_end(right, 1, thread.pull);
  add_end(left, -1, thread.pull);
  double range = 0;
  for (std::size_t k = 0; k < PointPull::kMost && thread.pull.weights[k] != 0; ++k)
    range = std::max(range, set.range(thread.pull.particles[k]));
  thread.least_length = kTautRanges * range;
}

bool ThreadList::find_held(const ParticleSet& set) {
  const std::vector<SutureThread>& of_set = StructureOf::in(set).tears.threads;
  if (!std::equal(threads_.begin(), threads_.end(), of_set.begin(), of_set.end(),
                  [](const Thread& thread, const SutureThread& of) { return thread.of == of; }))
    return false;
  for (Thread& thread : threads_) find_held(set, thread);
  return true;
}

void ThreadList::follow(const ParticleSet& set, Motion& motion) {
  const std::vector<SutureThread>& of_set = StructureOf::in(set).tears.threads;
  std::size_t known = 0;
  while (known < std::min(threads_.size(), of_set.size()) && threads_[known].of == of_set[known])
    ++known;
  for (std::size_t i = known; i < threads_.size(); ++i)  // undone
    for (std::size_t k = 0; k < PointPull::kMost && threads_[i].pull.weights[k] != 0; ++k)
      if (const Index p = threads_[i].pull.particles[k]; p < motion.count()) motion.wake(p);
  threads_.resize(known);
  loads_.resize(known);
  for (std::size_t i = known; i < of_set.size(); ++i) {
    threads_.emplace_back().of = of_set[i];
    loads_.emplace_back();
  }
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    find_held(set, threads_[i]);
    if (i >= known) wake(threads_[i], motion);
  }
}

void ThreadList::begin_step(const World& world, Motion& motion, std::vector<PointPull>& pulls) {
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    Thread& thread = threads_[i];
    if (!thread.holds() || loads_[i].is_broken) continue;
    const SurfacePose& posed = world.poses.at(world.model, world.pose, world.rests.epoch());
    thread.rest =
        posed.place(world.model, thread.of.right) - posed.place(world.model, thread.of.left);
    const Vec3d way = thread.way(motion);
    const double length = norm(way);
    if (norm(Vec3d(way - thread.felt)) > kFeltThreadLengths * thread.least_length) {
      thread.felt = way;
      wake(thread, motion);
    }
    if (!is_awake(thread, motion)) continue;
    for (std::size_t k = 0; k < PointPull::kMost && thread.pull.weights[k] != 0; ++k)
      motion.bound[thread.pull.particles[k]] = 1;
    PointPull& pull = pulls.emplace_back(thread.pull);
    pull.stiffness =
        thread.of.stiffness + thread.of.tension / std::max(length, thread.least_length);
    pull.frequency = std::sqrt(pull.stiffness / reduced_mass(pull, world.masses));
    pull.target = -thread.rest;
  }
}

bool ThreadList::end_step(Motion& motion) {
  bool has_broken = false;
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    const Thread& thread = threads_[i];
    if (!thread.holds() || loads_[i].is_broken) {
      loads_[i].newtons = 0;
      continue;
    }
    loads_[i].newtons = thread.newtons(norm(thread.way(motion)));
    if (thread.of.strength == 0 || !(loads_[i].newtons > thread.of.strength)) continue;
    loads_[i] = {0, true};
    wake(thread, motion);
    has_broken = true;
  }
  return has_broken;
}

std::size_t ThreadList::memory_bytes() const { return bytes_of(threads_) + bytes_of(loads_); }

}  // namespace sunder::particles
