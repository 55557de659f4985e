#include "particles/rupture/overstretch.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/internal/tolerances.h"
#include "particles/motion/pose_tension.h"
#include "particles/rupture/short_tear.h"

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

/// The cosine of the angle by which the tissue's plane turned, from moments as those of
/// strain_of().
double cosine_of_turn(const Mat3d& moved) {
  Mat3d areas;
  for (int i = 0; i < 3; ++i) areas.col(i) = moved.col((i + 1) % 3).cross(moved.col((i + 2) % 3));
  const double size = std::sqrt(squared_norm(areas));
  return size > 0 ? trace(areas) / size : 1.0;
}

/// The greatest strain of tissue that hardly turns, also where it is pressed through itself: that
/// of the symmetric part of the gradient in its plane. @param moments, moved  as those of
/// strain_of(), which is not zero.
double greatest_without_turn(const Mat3d& moments, const Mat3d& moved) {
  const double sum = trace(moments);
  const Mat3d square = multiply(moments, moments);
  const double determinant = 0.5 * (sum * sum - trace(square));  // of the moments in the plane
  const Mat3d inverse = (sum * Mat3d::Identity() - moments) / determinant;  // in the plane
  const Mat3d plane = multiply(moments, inverse);
  const Mat3d gradient = multiply(plane, multiply(moved, inverse)) - plane;
  return greatest_in_plane(0.5 * (gradient + gradient.transpose()));
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
  const Mat3d moved = moments + multiply(back, displaced), strain = strain_of(moments, moved);
  if (strain.isZero(0)) return 1 + strain_of_row(moments, multiply(back, displaced));
  return 1 + (cosine_of_turn(moved) < kPressedThroughCosine ? greatest_without_turn(moments, moved)
                                                            : greatest_in_plane(strain));
}

namespace {

/// How far a perforation is from the seed of a particle whose cell it passes, at most, in ranges.
constexpr double kPerforatedRanges = 0.6;

/// The strain across a line that tissue bears, by that which it has.
/// @return without a course if no line is near, or if it is stretched along the line.
Overstretched along_perforation(const Tissue& tissue, Index particle, double stretch,
                                double length) {
  Vec3d along = Vec3d::Zero();
  const Course course =
      tissue.perforations.around(tissue.position(tissue.set.seed(particle)),
                                 kPerforatedRanges * tissue.set.range(particle), length, along);
  if (course.empty()) return {};
  const Mat3d& turn = tissue.rests.turn(particle);
  const Vec3d direction = multiply(turn, along);
  Mat3d moments = Mat3d::Zero();
  for (const ParticleNeighbour& of : tissue.set.neighbours(particle)) {
    const Vec3d apart =
        tissue.position(tissue.set.seed(of.particle)) - tissue.position(tissue.set.seed(particle));
    moments += of.coupling * apart * apart.transpose();
  }
  const Vec3d normal = multiply(turn, across_plane(moments));
  if (normal.isZero(0)) return {};
  const Vec3d greatest = greatest_stretch_around(tissue, {particle, particle}, normal);
  const double part = 1 - dot(greatest, direction) * dot(greatest, direction);
  const double strain = (stretch - 1) * part;
  const double borne = course.strength * (tissue.material(particle).strength - 1);
  if (!(strain > borne)) return {};
  return {particle, (1 + strain) / (1 + borne), course};
}

}  // namespace

std::vector<Overstretched> find_overstretched(const Tissue& tissue, double length,
                                              double& greatest) {
  std::vector<Overstretched> found;
  for (Index p = 0; p < tissue.motion.count(); ++p) {
    const double strength = tissue.material(p).strength;
    if (!tissue.is_awake(p) || !(strength > 0)) continue;
    const double stretch = stretch_around(tissue, p);
    greatest = std::max(greatest, stretch);
    if (stretch > strength) found.push_back({p, stretch / strength});
    if (tissue.perforations.empty()) continue;
    const Overstretched along = along_perforation(tissue, p, stretch, length);
    if (!along.course.empty()) found.push_back(along);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Overstretched& a, const Overstretched& b) { return a.over > b.over; });
  return found;
}

}  // namespace sunder::particles
