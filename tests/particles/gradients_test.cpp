// Gradients of the weights of points, which turn normals where particles are displaced.

#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

float weight_of(const ParticleSet& set, std::uint32_t point, std::uint32_t particle) {
  const ParticleInfluences& of = set.influences()[point];
  for (std::size_t i = 0; i < 4; ++i)
    if (of.particles[i] == particle && of.weights[i] > 0) return of.weights[i];
  return 0.0f;
}

/// The gradient of a weight by its definition: per face the gradient with the differences along its
/// two edges; the mean by area. At a crease, the vector whose parts in the faces' planes have the
/// least squared distance from these gradients.
Vec3d gradient_by_faces(const TornModel& model, const ParticleSet& set, std::uint32_t point,
                        std::size_t i) {
  const tear::Surface& surface = model.surface();
  const std::uint32_t particle = set.influences()[point].particles[i];
  const double own = set.influences()[point].weights[i];
  Vec3d sum = Vec3d::Zero(), normals = Vec3d::Zero();
  Mat3d planes = Mat3d::Zero();
  double areas = 0;
  surface.for_each_in_fan(surface.point_corner[point], [&](std::uint32_t corner) {
    const std::uint32_t b = surface.corner_point[tear::Surface::next(corner)],
                        c = surface.corner_point[tear::Surface::previous(corner)];
    const Vec3d to_b = (set.positions()[b] - set.positions()[point]).cast<double>();
    const Vec3d to_c = (set.positions()[c] - set.positions()[point]).cast<double>();
    const double area = to_b.cross(to_c).norm();
    if (!(area > 1e-12 * to_b.norm() * to_c.norm())) return;
    Eigen::Matrix2d gram;
    gram << to_b.dot(to_b), to_b.dot(to_c), to_b.dot(to_c), to_c.dot(to_c);
    const Eigen::Vector2d parts =
        gram.inverse() *
        Eigen::Vector2d(weight_of(set, b, particle) - own, weight_of(set, c, particle) - own);
    sum += area * (parts.x() * to_b + parts.y() * to_c);
    areas += area;
    const Vec3d normal = to_b.cross(to_c) / area;
    normals += area * normal;
    planes += area * (Mat3d::Identity() - normal * normal.transpose());
  });
  if (areas > 0 && normals.norm() < 0.9 * areas) {
    const Vec3d across = normals.normalized();
    return (planes + 0.05 * areas * across * across.transpose()).inverse() * sum;
  }
  return areas > 0 ? Vec3d(sum / areas) : Vec3d(Vec3d::Zero());
}

/// Mean error of the weights of neighbouring points as predicted by gradients, relative to the mean
/// difference of these weights.
double error_of(std::uint32_t cells) {
  const auto source = std::make_shared<const Character>(make_sheet(cells));
  TornModel model = std::move(*TornModel::create(source));
  DecompositionOptions options;
  options.range = 0.2;
  ParticleSet set = std::move(*ParticleSet::create(model, *bind_pose(*source), options));
  const std::span<const ParticleGradients> gradients = set.gradients(model);
  double error = 0, difference = 0;
  const tear::Surface& surface = model.surface();
  for (std::uint32_t h = 0; h < surface.corner_point.size(); ++h) {
    const std::uint32_t a = surface.corner_point[h],
                        b = surface.corner_point[tear::Surface::next(h)];
    if (surface.is_on_border(a)) continue;
    const Vec3f along = set.positions()[b] - set.positions()[a];
    for (std::size_t i = 0; i < 4 && set.influences()[a].weights[i] > 0; ++i) {
      const float rise =
          weight_of(set, b, set.influences()[a].particles[i]) - set.influences()[a].weights[i];
      error += std::abs(rise - gradients[a].of_weights[i].dot(along));
      difference += std::abs(rise);
    }
  }
  return error / difference;
}

TEST(Gradients, predict_the_weights_of_neighbours) {
  const double coarse = error_of(32), fine = error_of(64);
  EXPECT_LT(coarse, 0.25);
  EXPECT_LT(fine, 0.65 * coarse);  // of first order
}

TEST(Gradients, lie_in_the_surface_and_cancel) {
  const auto source = std::make_shared<const Character>(make_sheet(24));
  TornModel model = std::move(*TornModel::create(source));
  ParticleSet set = std::move(*ParticleSet::create(model, *bind_pose(*source), {}));
  for (const ParticleGradients& of : set.gradients(model))
    for (const Vec3f& gradient : of.of_weights) EXPECT_NEAR(gradient.z(), 0.0f, 1e-4f);
}

TEST(Gradients, are_brought_up_to_date_by_tears) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto source = std::make_shared<const Character>(random_character(random));
    auto model = TornModel::create(source);
    ASSERT_TRUE(model);
    ParticleSet set = std::move(*ParticleSet::create(*model, *bind_pose(*source), {}));
    (void)set.gradients(*model);
    const auto expect_same_as_afresh = [&] {
      const std::span<const ParticleGradients> kept = set.gradients(*model);
      for (std::uint32_t point = 0; point < set.point_count(); ++point)
        for (std::size_t i = 0; i < 4; ++i) {
          if (model->surface().point_corner[point] == kNone ||
              !(set.influences()[point].weights[i] > 0))
            continue;
          const Vec3d expected = gradient_by_faces(*model, set, point, i);
          ASSERT_LT((kept[point].of_weights[i].cast<double>() - expected).norm(),
                    1e-3 * (1 + expected.norm()))
              << point;
        }
    };
    for (int k = 0; k < 3; ++k) {
      ChangeRecord change;
      if (!play(*model, random_operation(*model, random), &change)) continue;
      ASSERT_TRUE(set.follow(*model, std::span(&change, 1)));
      expect_same_as_afresh();
      while (set.settle(*model, 100)) expect_same_as_afresh();
    }
    ChangeRecord change;
    if (!model->undo(&change)) continue;
    ASSERT_TRUE(set.follow(*model, std::span(&change, 1)));
    expect_same_as_afresh();
  }
}

}  // namespace
}  // namespace sunder::test
