#include "particles/rupture/overstretch.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/motion/pose_tension.h"

namespace sunder::particles {
namespace {

/// The greatest eigenvalue of a symmetric matrix that has the eigenvalue 0.
double greatest_in_plane(const Mat3d& m) {
  const double half = 0.5 * trace(m);
  const double product = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1) + m(1, 1) * m(2, 2) -
                         m(1, 2) * m(1, 2) + m(2, 2) * m(0, 0) - m(2, 0) * m(2, 0);
  return half + std::sqrt(std::max(0.0, half * half - product));
}

/// The same where the neighbours are in a row, along which nothing is known of the other direction.
double strain_of_row(const Mat3d& moments, const Mat3d& displaced) {
  const double squares = trace(moments);
  return squares > 0 ? trace(displaced) / squares : 0.0;
}

}  // namespace

double stretch_around(const Tissue& tissue, Index particle) {
  const Vec3d seed = tissue.position(tissue.set.seed(particle));
  const Vec3d& displacement = tissue.motion.displacements[particle];
  Mat3d moments = Mat3d::Zero(), displaced = Mat3d::Zero();
  for (const ParticleNeighbour& of : tissue.set.neighbours(particle)) {
    const Vec3d before = tissue.position(tissue.set.seed(of.particle)) - seed;
    const Vec3d weighted = of.coupling * before;
    moments += weighted * before.transpose();
    displaced += (tissue.motion.displacements[of.particle] - displacement) * weighted.transpose();
  }
  // Displacements are along the axes of model space, in which the particle is turned.
  const Mat3d back = tissue.rests.turn(particle).transpose();
  const Mat3d strain = strain_of(moments, Mat3d(moments + multiply(back, displaced)));
  return 1 + (strain.isZero(0) ? strain_of_row(moments, multiply(back, displaced))
                               : greatest_in_plane(strain));
}

std::vector<Overstretched> find_overstretched(const Tissue& tissue, double& greatest) {
  std::vector<Overstretched> found;
  for (Index p = 0; p < tissue.motion.count(); ++p) {
    const double strength = tissue.material(p).strength;
    if (!tissue.is_awake(p) || !(strength > 0)) continue;
    const double stretch = stretch_around(tissue, p);
    greatest = std::max(greatest, stretch);
    if (stretch > strength) found.push_back({p, stretch / strength});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Overstretched& a, const Overstretched& b) { return a.over > b.over; });
  return found;
}

}  // namespace sunder::particles
