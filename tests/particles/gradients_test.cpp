// Gradients of the weights of points, which turn normals where particles are displaced.

#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <vector>

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

/// The gradient of a particle's weight by its definition: per face the gradient with the
/// differences along its two edges; the mean by area. At a crease, the vector whose parts in the
/// faces' planes have the least squared distance from these gradients.
Vec3d gradient_by_faces(const TornModel& model, const ParticleSet& set, std::uint32_t point,
                        std::uint32_t particle) {
  const tear::Surface& surface = model.surface();
  const double own = weight_of(set, point, particle);
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

/// The particles of a point and of its neighbours.
std::set<std::uint32_t> particles_around(const TornModel& model, const ParticleSet& set,
                                         std::uint32_t point) {
  std::set<std::uint32_t> particles;
  const auto add = [&](std::uint32_t of) {
    for (std::size_t i = 0; i < 4 && set.influences()[of].weights[i] > 0; ++i)
      particles.insert(set.influences()[of].particles[i]);
  };
  add(point);
  const tear::Surface& surface = model.surface();
  surface.for_each_in_fan(surface.point_corner[point], [&](std::uint32_t corner) {
    add(surface.corner_point[tear::Surface::next(corner)]);
    add(surface.corner_point[tear::Surface::previous(corner)]);
  });
  return particles;
}

bool is_creased(const TornModel& model, const ParticleSet& set, std::uint32_t point) {
  Vec3d normals = Vec3d::Zero();
  double areas = 0;
  const tear::Surface& surface = model.surface();
  surface.for_each_in_fan(surface.point_corner[point], [&](std::uint32_t corner) {
    const std::uint32_t b = surface.corner_point[tear::Surface::next(corner)],
                        c = surface.corner_point[tear::Surface::previous(corner)];
    const Vec3d normal = (set.positions()[b] - set.positions()[point])
                             .cast<double>()
                             .cross((set.positions()[c] - set.positions()[point]).cast<double>());
    normals += normal;
    areas += normal.norm();
  });
  return normals.norm() < 0.91 * areas;
}

/// None of the four is shorter than one that is left out; what the others have is added to them, by
/// their weights at the point.
void expect_right(const TornModel& model, const ParticleSet& set, std::uint32_t point,
                  const ParticleGradients& found) {
  std::map<std::uint32_t, Vec3d> expected;
  double longest = 0;
  for (const std::uint32_t particle : particles_around(model, set, point)) {
    expected[particle] = gradient_by_faces(model, set, point, particle);
    longest = std::max(longest, expected[particle].norm());
  }
  std::set<std::uint32_t> kept;
  double shortest = longest, whole = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(found.of_weights[i].norm() > 0)) continue;
    ASSERT_TRUE(kept.insert(found.particles[i]).second && expected.contains(found.particles[i]));
    shortest = std::min(shortest, expected.at(found.particles[i]).norm());
    whole += weight_of(set, point, found.particles[i]);
  }
  Vec3d rest = Vec3d::Zero();
  // At a crease the parts across it count more once four are chosen.
  const double margin = is_creased(model, set, point) ? 25 : 1.01;
  for (const auto& [particle, gradient] : expected) {
    if (kept.contains(particle)) continue;
    rest += gradient;
    ASSERT_TRUE(kept.size() < 4 || gradient.norm() <= margin * shortest + 1e-3 * (1 + longest))
        << point;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(found.of_weights[i].norm() > 0)) continue;
    const double share = whole > 0 ? weight_of(set, point, found.particles[i]) / whole
                                   : 1 / static_cast<double>(kept.size());
    ASSERT_LT((found.of_weights[i].cast<double>() - expected.at(found.particles[i]) - share * rest)
                  .norm(),
              2e-3 * (1 + longest))
        << point;
  }
}

/// What a field that is given at the points is at the particles: the mean over their points.
std::vector<double> at_particles(const ParticleSet& set,
                                 const std::function<double(const Vec3d&)>& field) {
  std::vector<double> sums(set.particle_count()), sizes(set.particle_count());
  for (std::uint32_t point = 0; point < set.point_count(); ++point)
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t particle = set.influences()[point].particles[i];
      const double weight = set.influences()[point].weights[i];
      sizes[particle] += weight;
      sums[particle] += weight * field(set.positions()[point].cast<double>());
    }
  for (std::size_t p = 0; p < sums.size(); ++p)
    if (sizes[p] > 0) sums[p] /= sizes[p];
  return sums;
}

/// How far the difference of what two points get from the particles is from what the gradients at
/// the first one predict, relative to the difference.
class Prediction {
 public:
  Prediction(const ParticleSet& set, std::span<const ParticleGradients> gradients,
             std::vector<double> of_particles)
      : set_(set), gradients_(gradients), of_particles_(std::move(of_particles)) {}

  void compare(std::uint32_t a, std::uint32_t b) {
    const Vec3f along = set_.positions()[b] - set_.positions()[a];
    double predicted = 0;
    for (std::size_t i = 0; i < 4; ++i)
      predicted += of_particles_[gradients_[a].particles[i]] *
                   static_cast<double>(gradients_[a].of_weights[i].dot(along));
    const double difference = at(b) - at(a);
    error_ += std::abs(predicted - difference);
    difference_ += std::abs(difference);
  }
  [[nodiscard]] double error() const { return error_ / difference_; }

 private:
  [[nodiscard]] double at(std::uint32_t point) const {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += static_cast<double>(set_.influences()[point].weights[i]) *
             of_particles_[set_.influences()[point].particles[i]];
    return sum;
  }

  const ParticleSet& set_;
  std::span<const ParticleGradients> gradients_;
  std::vector<double> of_particles_;
  double error_ = 0, difference_ = 0;
};

double error_of(std::uint32_t cells) {
  const auto source = std::make_shared<const Character>(make_sheet(cells));
  TornModel model = std::move(*TornModel::create(source));
  DecompositionOptions options;
  options.range = 0.2;
  ParticleSet set = std::move(*ParticleSet::create(model, *bind_pose(*source), options));
  Prediction prediction(set, set.gradients(model), at_particles(set, [](const Vec3d& at) {
                          return std::sin(5 * at.x()) * std::cos(4 * at.y());
                        }));
  const tear::Surface& surface = model.surface();
  for (std::uint32_t h = 0; h < surface.corner_point.size(); ++h)
    if (const std::uint32_t a = surface.corner_point[h]; !surface.is_on_border(a))
      prediction.compare(a, surface.corner_point[tear::Surface::next(h)]);
  return prediction.error();
}

TEST(Gradients, predict_how_neighbours_move) {
  const double coarse = error_of(32), fine = error_of(64);
  EXPECT_LT(coarse, 0.25);
  EXPECT_LT(fine, 0.65 * coarse);  // of first order
}

TEST(Gradients, lie_in_the_surface_and_cancel) {
  const auto source = std::make_shared<const Character>(make_sheet(24));
  TornModel model = std::move(*TornModel::create(source));
  ParticleSet set = std::move(*ParticleSet::create(model, *bind_pose(*source), {}));
  for (const ParticleGradients& of : set.gradients(model)) {
    Vec3f sum = Vec3f::Zero();
    float longest = 0;
    for (const Vec3f& gradient : of.of_weights) {
      EXPECT_NEAR(gradient.z(), 0.0f, 1e-4f);
      sum += gradient;
      longest = std::max(longest, gradient.norm());
    }
    EXPECT_LE(sum.norm(), 1e-5f * longest);
  }
}

TEST(Gradients, at_lips_predict_how_neighbours_move) {
  // Points of a lip belong to particles of the lip alone, their neighbours to others as well.
  const auto source = std::make_shared<const Character>(make_sheet(20));
  TornModel model = std::move(*TornModel::create(source));
  DecompositionOptions options;
  options.range = 0.15;
  const ModelPose pose = *bind_pose(*source);
  ParticleSet set = std::move(*ParticleSet::create(model, pose, options));
  ChangeRecord change;
  const Stroke stroke = {{{0.21, 0.48, 1}, {0.21, 0.48, -1}}, {{0.83, 0.53, 1}, {0.83, 0.53, -1}}};
  ASSERT_TRUE(model.tear(pose, stroke, {}, &change));
  ASSERT_TRUE(set.follow(model, std::span(&change, 1)));
  while (set.settle(model, 1000)) {
  }
  // Lips move the most.
  Prediction prediction(set, set.gradients(model), at_particles(set, [](const Vec3d& at) {
                          return std::exp(-8 * std::abs(at.y() - 0.5));
                        }));
  const tear::Surface& surface = model.surface();
  ASSERT_GT(change.lips.size(), 20u);
  for (const LipPair& pair : change.lips)
    for (const std::uint32_t a : {pair.left, pair.right})
      surface.for_each_in_fan(surface.point_corner[a], [&](std::uint32_t corner) {
        prediction.compare(a, surface.corner_point[tear::Surface::next(corner)]);
      });
  EXPECT_LT(prediction.error(), 0.5);
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
      for (std::uint32_t point = 0; point < set.point_count(); ++point) {
        if (model->surface().point_corner[point] == kNone) continue;
        ASSERT_NO_FATAL_FAILURE(expect_right(*model, set, point, kept[point]));
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
