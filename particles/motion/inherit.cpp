#include "particles/motion/inherit.h"

namespace sunder::particles {

void inherit(const ParticleInfluences& parents, Index particle, RestMotion& rests, Motion& motion) {
  Vec3d displacement = Vec3d::Zero(), velocity = Vec3d::Zero(), rest_velocity = Vec3d::Zero();
  Mat3d kept = Mat3d::Zero();
  double sum = 0;
  motion.material_of[particle] = 0;
  for (std::size_t k = 0; k < 4 && parents.weights[k] > 0; ++k) {
    const Index parent = parents.particles[k];
    if (parent >= motion.count() || parent == particle) continue;
    if (!(sum > 0)) motion.material_of[particle] = motion.material_of[parent];
    const double weight = parents.weights[k];
    displacement += weight * motion.displacements[parent];
    velocity += weight * motion.velocities[parent];
    rest_velocity += weight * rests.velocity(parent);
    if (!motion.plastic.strains.empty()) kept += weight * motion.plastic.strains[parent];
    sum += weight;
  }
  for (auto* vectors : {&motion.forces, &motion.lip_forces, &motion.winds, &motion.quiet.pulls})
    (*vectors)[particle].setZero();
  if (!(sum > 0)) sum = 1;
  motion.displacements[particle] = motion.starts[particle] = displacement / sum;
  motion.velocities[particle] = velocity / sum;
  if (!motion.plastic.strains.empty()) motion.plastic.strains[particle] = kept / sum;
  rests.set_velocity(particle, rest_velocity / sum);
  motion.touched[particle] = motion.bound[particle] = 0;
  motion.wake(particle);
  motion.quiet.from[particle] = motion.displacements[particle];
}

}  // namespace sunder::particles
