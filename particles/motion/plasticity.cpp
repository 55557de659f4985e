#include "particles/motion/plasticity.h"

#include <cmath>

#include "core/internal/ordered.h"
#include "particles/motion/pose_tension.h"

namespace sunder::particles {
namespace {

Vec3d seed_at(const ParticleSet& set, Index p) {
  return set.positions()[set.seed(p)].cast<double>();
}

/// The gradient of the displacement around a particle, along the axes of the decomposition's pose;
/// zero where its neighbours are in a row.
Mat3d gradient_around(const PlasticWorld& world, Index p, const Motion& motion) {
  const Vec3d seed = seed_at(world.set, p);
  Mat3d moments = Mat3d::Zero(), moved = Mat3d::Zero();
  for (const ParticleNeighbour& of : world.set.neighbours(p)) {
    const Vec3d apart = seed_at(world.set, of.particle) - seed;
    const Vec3d weighted = of.coupling * apart;
    moments += weighted * apart.transpose();
    moved += (motion.displacements[of.particle] - motion.displacements[p]) * weighted.transpose();
  }
  const Mat3d back = world.rests.turn(p).transpose();
  return gradient_in_plane(moments, multiply(back, moved));
}

/// A matrix whose norm is at most a limit.
Mat3d limited(const Mat3d& matrix, double limit) {
  const double size = norm(matrix);
  return size > limit ? Mat3d(limit / size * matrix) : matrix;
}

}  // namespace

void flow(const PlasticWorld& world, std::span<const Index> active, Motion& motion) {
  std::vector<Mat3d>& strains = motion.plastic.strains;
  bool has_flowed = false;
  for (const Index p : active) {
    const SoftMaterial& material = world.graph.material(p, world.materials, motion.material_of);
    if (!(material.yield_stretch > 1)) continue;
    const Mat3d gradient = gradient_around(world, p, motion);
    if (gradient.isZero(0)) continue;
    const Mat3d kept = strains.empty() ? Mat3d(Mat3d::Zero()) : strains[p];
    const Mat3d elastic = gradient - kept;
    const double size = norm(elastic), most = material.yield_stretch - 1;
    if (!(size > most)) continue;
    const Mat3d now = limited(kept + (1 - most / size) * elastic, material.plastic_limit);
    if (now == kept) continue;
    if (strains.empty()) motion.plastic.resize(motion.count());
    strains[p] = now;
    has_flowed = true;
  }
  if (has_flowed) push_by_strains(world.set, world.graph, motion);
}

void push_by_strains(const ParticleSet& set, const SpringGraph& graph, Motion& motion) {
  const std::vector<Mat3d>& strains = motion.plastic.strains;
  if (strains.empty()) return;
  for (Index p = 0; p < motion.count(); ++p) {
    Vec3d sum = Vec3d::Zero();
    const Vec3d seed = seed_at(set, p);
    for (const Spring& spring : graph.of(p)) {
      const Mat3d mean = 0.5 * (strains[p] + strains[spring.other]);
      sum -= spring.stiffness * multiply(mean, Vec3d(seed_at(set, spring.other) - seed));
    }
    motion.plastic.forces[p] = sum;
  }
}

}  // namespace sunder::particles
