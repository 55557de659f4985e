#include "particles/motion/pose_tension.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/internal/ordered.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// The square root of a symmetric positive semidefinite matrix.
Eigen::Matrix2d root_of(const Eigen::Matrix2d& m) {
  const double root = std::sqrt(std::max(0.0, m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0)));
  const double sum = std::sqrt(std::max(0.0, trace(m) + 2 * root));
  if (!(sum > 0)) return Eigen::Matrix2d::Zero();
  return (m + root * Eigen::Matrix2d::Identity()) / sum;
}

/// Two directions of a plane, and the linear map of it that fits best how vectors in it change.
struct Fit {
  Eigen::Matrix<double, 3, 2> plane, gradient;
};

std::optional<Fit> fit_in_plane(const Mat3d& moments, const Mat3d& moved) {
  const Vec3d normal = across_plane(moments);
  if (normal.isZero(0)) return {};
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal.unitOrthogonal();
  plane.col(1) = normal.cross(plane.col(0));
  const Eigen::Matrix2d in_plane = multiply(plane.transpose(), multiply(moments, plane));
  const double size = trace(in_plane),
               determinant = in_plane(0, 0) * in_plane(1, 1) - in_plane(0, 1) * in_plane(1, 0);
  if (!(determinant > kRowDeterminantFraction * size * size)) return {};
  Eigen::Matrix2d adjugate;
  adjugate << in_plane(1, 1), -in_plane(0, 1), -in_plane(1, 0), in_plane(0, 0);
  return Fit{plane, multiply(multiply(moved, plane), Eigen::Matrix2d(adjugate / determinant))};
}

}  // namespace

Vec3d across_plane(const Mat3d& moments) {
  Vec3d longest = Vec3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec3d column = moments.col((i + 1) % 3).cross(moments.col((i + 2) % 3));
    if (squared_norm(column) > squared_norm(longest)) longest = column;
  }
  return normalized(longest);
}

Mat3d gradient_in_plane(const Mat3d& moments, const Mat3d& moved) {
  const std::optional<Fit> fit = fit_in_plane(moments, moved);
  return fit ? Mat3d(multiply(fit->gradient, fit->plane.transpose())) : Mat3d(Mat3d::Zero());
}

Mat3d strain_of(const Mat3d& moments, const Mat3d& moved) {
  const std::optional<Fit> fit = fit_in_plane(moments, moved);
  if (!fit) return Mat3d::Zero();
  const auto& [plane, gradient] = *fit;
  const Eigen::Matrix2d strain =
      root_of(multiply(gradient.transpose(), gradient)) - Eigen::Matrix2d::Identity();
  return multiply(plane, multiply(strain, plane.transpose()));
}

void PoseTension::resize(Index particles) {
  added_.resize(particles, Mat3d::Zero());
  posed_seeds_.resize(particles);
  is_posed_.resize(particles);
  is_known_.resize(particles);
}

void PoseTension::update(const ParticleSet& set, const TornModel& model, const SurfacePose& pose,
                         std::span<const SoftMaterial> materials,
                         std::span<const Index> material_of, const SpringGraph& graph) {
  std::fill(added_.begin(), added_.end(), Mat3d::Zero());
  std::fill(is_posed_.begin(), is_posed_.end(), std::uint8_t{0});
  std::fill(is_known_.begin(), is_known_.end(), std::uint8_t{0});
  const auto seed_before = [&](Index particle) { return set.positions()[set.seed(particle)]; };
  const auto seed_now = [&](Index particle) {
    if (std::exchange(is_posed_[particle], std::uint8_t{1}) == 0)
      posed_seeds_[particle] = pose.place(model, set.seed(particle));
    return posed_seeds_[particle];
  };
  const auto evaluate = [&](Index particle) {
    Mat3d moments = Mat3d::Zero(), moved = Mat3d::Zero();
    double couplings = 0;
    for (const ParticleNeighbour& of : set.neighbours(particle)) {
      const Vec3d before = Vec3f(seed_before(of.particle) - seed_before(particle)).cast<double>();
      const Vec3d now = seed_now(of.particle) - seed_now(particle);
      moments += of.coupling * before * before.transpose();
      moved += of.coupling * now * before.transpose();
      couplings += of.coupling;
    }
    const Mat3d strain = strain_of(moments, moved);
    const double rounding = kRoundedStrain * norm(seed_before(particle));
    if (squared_norm(strain) * trace(moments) <= rounding * rounding * couplings) return;
    const SoftMaterial& material = graph.material(particle, materials, material_of);
    added_[particle] = material.membrane_stiffness * strain;
  };
  for (const LipEdge& lip : set.lips())
    for (const Index point : lip.points)
      if (const Index owner = set.owners()[point];
          owner != kNone && std::exchange(is_known_[owner], std::uint8_t{1}) == 0)
        evaluate(owner);
}

std::size_t PoseTension::memory_bytes() const {
  return added_.capacity() * sizeof(Mat3d) + posed_seeds_.capacity() * sizeof(Vec3d) +
         is_posed_.capacity() + is_known_.capacity();
}

}  // namespace sunder::particles
