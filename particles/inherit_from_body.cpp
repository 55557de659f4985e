#include <sunder/particles/soft_body.h>

#include <new>

#include "core/internal/out_of_memory.h"
#include "particles/body_state.h"
#include "particles/clusters/influences.h"

namespace sunder {
namespace {

using particles::BodyState;
using particles::for_each_influence;

/// Sweeps that fit particles to points. Each reduces the difference by a factor of about two.
constexpr int kSweeps = 12;

/// The motion of points, as three coordinates of the displacement and three of the velocity.
using Moved = Eigen::Matrix<double, 6, 1>;

Moved moved_by(const ParticleInfluences& of, const std::vector<Moved>& particles) {
  Moved sum = Moved::Zero();
  for_each_influence(of, [&](Index p, double weight) { sum += weight * particles[p]; });
  return sum;
}

/// Finds a motion of particles that moves points as wanted, in the sense of least squares: the
/// simultaneous iterative reconstruction, whose rows and columns are divided by their sums.
/// @param wanted  of the points that are known, and their influences.
std::vector<Moved> fit(std::span<const std::pair<ParticleInfluences, Moved>> wanted,
                       std::size_t particle_count) {
  std::vector<Moved> found(particle_count, Moved::Zero()), step(particle_count);
  std::vector<double> weights(particle_count, 0.0);
  for (const auto& [of, moved] : wanted)
    for_each_influence(of, [&](Index p, double weight) { weights[p] += weight; });
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    step.assign(particle_count, Moved::Zero());
    for (const auto& [of, moved] : wanted) {
      const Moved missing = moved - moved_by(of, found);
      for_each_influence(of, [&](Index p, double weight) { step[p] += weight * missing; });
    }
    for (std::size_t p = 0; p < particle_count; ++p)
      if (weights[p] > 0) found[p] += step[p] / weights[p];
  }
  return found;
}

/// Each particle gets the material of its seed there.
void inherit_materials(BodyState& to, std::span<const PointMotion> motions) {
  for (Index p = 0; p < to.motion.count(); ++p) {
    const PointMotion& of = motions[to.set->seed(p)];
    if (!of.is_known || of.material >= to.materials.size() ||
        to.motion.material_of[p] == of.material)
      continue;
    to.motion.material_of[p] = of.material;
    to.graph.is_stale = true;
  }
}

/// @throws std::bad_alloc
void inherit(BodyState& to, std::span<const PointMotion> motions) {
  to.follow_particles();
  std::vector<std::pair<ParticleInfluences, Moved>> wanted;
  wanted.reserve(motions.size());
  for (Index point = 0; point < motions.size(); ++point) {
    if (!motions[point].is_known) continue;
    Moved moved;
    moved << motions[point].displacement, motions[point].velocity;
    wanted.emplace_back(to.set->influences()[point], moved);
  }
  const std::vector<Moved> found = fit(wanted, to.motion.count());
  inherit_materials(to, motions);
  for (Index p = 0; p < to.motion.count(); ++p) {
    if (found[p] == Moved::Zero()) continue;
    to.motion.displacements[p] = to.motion.starts[p] = found[p].head<3>();
    to.motion.velocities[p] = found[p].tail<3>();
    to.wake_around(p);
  }
  to.show();
}

}  // namespace

Status SoftBody::inherit_motion_from(std::span<const PointMotion> motions) {
  BodyState& to = *state_;
  if (motions.size() != to.set->point_count())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "there are %zu motions; the particles have %u points", motions.size(),
                           to.set->point_count());
  for (Index point = 0; point < motions.size(); ++point)
    if (!motions[point].displacement.allFinite() || !motions[point].velocity.allFinite())
      return Status::failure(StatusCode::non_finite_value, point,
                             "the motion of point %u is not finite", point);
  try {
    inherit(to, motions);
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

std::vector<PointMotion> SoftBody::particle_motions() const {
  const BodyState& of = *state_;
  std::vector<PointMotion> motions;
  if (of.set->revision() != of.revision) return motions;
  motions.reserve(of.motion.count());
  for (Index p = 0; p < of.motion.count(); ++p)
    motions.push_back(
        {true, of.motion.material_of[p], of.motion.displacements[p], of.motion.velocities[p]});
  return motions;
}

PointMotion motion_at(const ParticleInfluences& of, std::span<const PointMotion> particles) {
  PointMotion motion;
  motion.is_known = of.weights[0] > 0 && !particles.empty();
  if (!motion.is_known) return motion;
  motion.material = particles[of.particles[0]].material;
  for_each_influence(of, [&](Index p, double weight) {
    motion.displacement += weight * particles[p].displacement;
    motion.velocity += weight * particles[p].velocity;
  });
  return motion;
}

}  // namespace sunder
