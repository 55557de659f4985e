#include "particles/rupture/short_tear.h"

#include <Eigen/Eigenvalues>

#include "core/internal/ordered.h"
#include "particles/clusters/lip_border.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// Orients the direction of a tear away from the border edges that end at its tip.
void run_forward(const TornModel& model, const SurfacePose& pose, Index tip, ShortTear& tear) {
  const LipBorder border(model);
  Vec3d forward = tear.from - 0.5 * (pose.place(model, border.next(tip)) +
                                     pose.place(model, border.previous(tip)));
  forward -= dot(forward, tear.normal) * tear.normal;
  if (!(norm(forward) > 0)) return;
  forward /= norm(forward);
  if (dot(tear.direction, forward) < 0) tear.direction = -tear.direction;
  if (dot(tear.direction, forward) < kLeastForwardCosine)
    tear.direction = normalized(tear.direction + forward);
}

/// Neighbouring blades of a stroke must differ by less than 90 degrees: where the surface folds
/// over by more between two places, the tear ends.
void end_at_fold(const Vec3d& normal, ShortTear& tear) {
  const Vec3d* last = &normal;
  for (std::size_t i = 0; i < tear.path.size(); ++i) {
    if (!(dot(*last, tear.path[i].second) > kLeastForwardCosine)) return tear.path.resize(i);
    last = &tear.path[i].second;
  }
}

/// Along a perforation.
ShortTear place_course(const Tissue& tissue, const SurfacePose& pose, const TearStart& start) {
  ShortTear tear;
  tear.path = tissue.perforations.posed(start.course, tissue.model, pose);
  tear.length = start.course.length;
  if (tear.path.size() < (start.is_tip ? 1u : 2u)) return tear;
  tear.from = start.is_tip ? pose.place(tissue.model, start.point) : tear.path.front().first;
  const Vec3d normal = start.is_tip ? pose.normal(tissue.model, start.point) : tear.path[0].second;
  if (!start.is_tip) tear.path.erase(tear.path.begin());
  end_at_fold(normal, tear);
  if (tear.path.empty()) return tear;
  tear.direction = normalized(Vec3d(tear.path.front().first - tear.from));
  if (!tear.direction.isZero(0)) tear.normal = normal;
  return tear;
}

}  // namespace

/// It is that of the linear map that best describes the change of the
/// vectors to their neighbours, so an uneven distribution of neighbours does not rotate it. It is
/// the direction in the current tissue: at a tip, the lips move apart across it.
Vec3d greatest_stretch_around(const Tissue& tissue, const std::array<Index, 2>& particles,
                              const Vec3d& normal) {
  const auto rest = [&](Index particle) { return tissue.rests.place(particle); };
  const auto place = [&](Index particle) {
    return Vec3d(rest(particle) + tissue.motion.displacements[particle]);
  };
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  Eigen::Matrix<double, 3, 2> moved = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d at_rest = Eigen::Matrix2d::Zero();
  Vec3d longest = Vec3d::Zero();
  for (const Index particle : particles)
    for (const ParticleNeighbour& neighbour : tissue.set.neighbours(particle)) {
      const Vec3d before = rest(neighbour.particle) - rest(particle);
      const Eigen::Vector2d along = multiply(plane.transpose(), before);
      const Eigen::Vector3d now = place(neighbour.particle) - place(particle);
      const double weight = neighbour.coupling;
      moved += weight * now * along.transpose();
      at_rest += weight * along * along.transpose();
      if (squared_norm(before) > squared_norm(longest)) longest = before;
    }
  const double size = trace(at_rest);
  if (!(at_rest.determinant() > kRowDeterminantFraction * size * size)) {  // all in a row
    const Eigen::Vector2d along = multiply(plane.transpose(), longest);
    return norm(along) > 0 ? Vec3d(multiply(plane, normalized(along))) : Vec3d(plane.col(0));
  }
  const Eigen::Matrix<double, 3, 2> map = multiply(moved, Eigen::Matrix2d(at_rest.inverse()));
  const Eigen::Matrix2d within = multiply(plane.transpose(), map);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(multiply(within, within.transpose()));
  return multiply(plane, solver.eigenvectors().col(1));
}

ShortTear place_tear(const Tissue& tissue, const SurfacePose& pose, const TearStart& start,
                     double length) {
  if (!start.course.empty()) return place_course(tissue, pose, start);
  ShortTear tear;
  tear.length = length;
  tear.normal = pose.normal(tissue.model, start.point);
  if (tear.normal.isZero(0)) return tear;
  tear.from = pose.place(tissue.model, start.point);
  tear.direction = tear.normal.cross(greatest_stretch_around(tissue, start.particles, tear.normal));
  if (start.is_tip)
    run_forward(tissue.model, pose, start.point, tear);
  else
    tear.from -= 0.5 * length * tear.direction;
  return tear;
}

}  // namespace sunder::particles
