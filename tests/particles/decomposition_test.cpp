// Compares the points of particles with distances from independent methods.
#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/particle_laws.h"
#include "support/oracles/surface_distances.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using testing::HasSubstr;
using testing::IsEmpty;

/// The fraction of its range within which a particle covers points: kSeedSpacingReach of
/// particles/internal/tolerances.h.
constexpr double kCovers = 0.85;

ParticleSet decompose(const TornModel& model, const DecompositionOptions& options) {
  auto set = ParticleSet::create(model, *bind_pose(model.source()), options);
  EXPECT_TRUE(set) << set.error().text();
  return std::move(*set);
}

bool is_member(const ParticleSet& set, std::uint32_t point, std::uint32_t particle) {
  return std::ranges::any_of(set.memberships(point),
                             [&](const ParticleMembership& of) { return of.particle == particle; });
}

/// Calls distances(seed) for the true distances from a seed, and compares.
/// @param error  relative accuracy of the distances.
template <class Distances>
void expect_ranges(const ParticleSet& set, Distances distances, double error) {
  std::vector<double> nearest_seed(set.point_count(), std::numeric_limits<double>::infinity());
  for (std::uint32_t p = 0; p < set.particle_count(); ++p) {
    SCOPED_TRACE(p);
    const double range = set.range(p);
    const std::vector<double> truth = distances(set.seed(p));
    for (std::uint32_t point = 0; point < set.point_count(); ++point) {
      nearest_seed[point] = std::min(nearest_seed[point], truth[point]);
      const bool is_in = is_member(set, point, p);
      if (truth[point] < (1 - error) * range) {
        ASSERT_TRUE(is_in) << "point " << point << " is at " << truth[point] / range
                           << " of the range";
      }
      if (truth[point] > (1 + error) * range) {
        ASSERT_FALSE(is_in) << "point " << point << " is at " << truth[point] / range
                            << " of the range";
      }
    }
    const std::vector<std::uint32_t> members = set.members(p).value();
    for (const std::uint32_t point : members)
      for (const ParticleMembership& of : set.memberships(point))
        if (of.particle == p) {
          ASSERT_NEAR(double{of.reach}, truth[point] / range, error) << "point " << point;
        }
    for (std::uint32_t other = 0; other < p; ++other)
      ASSERT_GT(truth[set.seed(other)], (kCovers - error) * range)
          << "from the seed of particle " << other;
  }
  for (std::uint32_t point = 0; point < set.point_count(); ++point) {
    if (set.memberships(point).empty()) continue;
    ASSERT_LT(nearest_seed[point], (kCovers + error) * set.report().range) << "point " << point;
  }
}

TEST(Decomposition, takes_points_within_range_on_a_flat_sheet) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(12, 50)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TornModel model = make_model(test::make_sheet(5 + random.index(36)));
    const ParticleSet set = decompose(model, {random.uniform(0.08, 0.6), false, seed});
    const auto distances = [&](std::uint32_t from) {
      std::vector<double> truth;
      for (const Vec3f& position : set.positions())
        truth.push_back(double{(position - set.positions()[from]).norm()});
      return truth;
    };
    ASSERT_NO_FATAL_FAILURE(expect_ranges(set, distances, 0.01));
    ASSERT_THAT(test::broken_particles(model, set), IsEmpty());
  }
}

TEST(Decomposition, takes_points_within_range_on_a_folded_sheet) {
  // Two layers, a cell apart; unfolded it is flat.
  for (const std::uint32_t cells : {11u, 21u, 41u}) {
    SCOPED_TRACE(cells);
    Character folded = test::make_sheet(cells);
    const std::uint32_t fold = cells / 2;
    const float cell = 1.0f / static_cast<float>(cells);
    std::vector<Vec3f>& positions = folded.meshes[0].positions;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      const std::uint32_t column = v % (cells + 1);
      if (column > fold)
        positions[v] = {static_cast<float>(2 * fold + 1 - column) * cell, positions[v].y(), cell};
    }
    const TornModel model = make_model(std::move(folded));
    const ParticleSet set = decompose(model, {0.3, false, 1});
    const auto unfolded = [&](std::uint32_t point) {
      const Vec3d at = set.positions()[point].cast<double>();
      return Vec3d(at.z() > 0.5 * double{cell} ? (2 * fold + 1.0) * double{cell} - at.x() : at.x(),
                   at.y(), 0);
    };
    const auto distances = [&](std::uint32_t from) {
      std::vector<double> truth;
      for (std::uint32_t point = 0; point < set.point_count(); ++point)
        truth.push_back((unfolded(point) - unfolded(from)).norm());
      return truth;
    };
    ASSERT_NO_FATAL_FAILURE(expect_ranges(set, distances, 0.01));
  }
}

TEST(Decomposition, takes_points_within_range_on_an_unrolled_tube) {
  for (const std::uint32_t sides : {10u, 24u}) {
    SCOPED_TRACE(sides);
    Character tube = test::make_tube(3 * sides, sides, 6);
    auto& triangles = tube.meshes[0].triangles;  // without its caps, over which paths could lead
    auto& submesh = tube.meshes[0].triangle_submesh;
    triangles.resize(static_cast<std::size_t>(std::ranges::find(submesh, 1u) - submesh.begin()));
    submesh.resize(triangles.size());
    const TornModel model = make_model(std::move(tube));
    const ParticleSet set = decompose(model, {0.9, false, 7});
    const double chord = std::sin(std::numbers::pi / sides), around = chord * sides;
    const auto unrolled = [&](std::uint32_t point) {
      const Vec3f& at = set.positions()[point];
      return std::round(std::atan2(-double{at.z()}, double{at.x()}) / (2 * std::numbers::pi) *
                        sides) *
             chord;
    };
    const auto distances = [&](std::uint32_t from) {
      std::vector<double> truth;
      for (std::uint32_t point = 0; point < set.point_count(); ++point) {
        double beside = std::abs(unrolled(point) - unrolled(from));
        beside = std::min(beside, around - beside);
        truth.push_back(model.surface().point_corner[point] == kNone
                            ? 1e9
                            : std::hypot(beside, double{set.positions()[point].y() -
                                                        set.positions()[from].y()}));
      }
      return truth;
    };
    ASSERT_NO_FATAL_FAILURE(expect_ranges(set, distances, 0.01));
  }
}

TEST(Decomposition, takes_points_within_range_on_a_bumpy_ball) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(3, 10)); ++seed) {
    SCOPED_TRACE(seed);
    const TornModel model = make_model(test::make_bumpy_ball(700));
    const ParticleSet set = decompose(model, {0.25, true, seed});
    const auto distances = [&](std::uint32_t from) {
      return test::fine_distances(model.surface(), set.positions(), from, 5);
    };
    ASSERT_NO_FATAL_FAILURE(expect_ranges(set, distances, 0.03));
  }
}

TEST(Decomposition, does_not_reach_through_the_air) {
  for (const std::uint32_t cells : {6u, 14u}) {
    Character sheets = test::make_sheet(cells);
    Mesh& mesh = sheets.meshes[0];
    const Character upper = test::make_sheet(cells);
    const std::uint32_t first = mesh.vertex_count();
    for (std::uint32_t v = 0; v < first; ++v) {
      mesh.positions.push_back(upper.meshes[0].positions[v] + Vec3f(0, 0, 0.02f));
      mesh.normals.push_back(upper.meshes[0].normals[v]);
      mesh.uv_sets[0].push_back(upper.meshes[0].uv_sets[0][v]);
      const auto influences = upper.meshes[0].weights.of(v);
      mesh.weights.append(std::vector<Influence>(influences.begin(), influences.end()));
    }
    for (const Triangle& t : upper.meshes[0].triangles)
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
    const TornModel model = make_model(std::move(sheets));
    const ParticleSet set = decompose(model, {0.4, false, 0});
    EXPECT_THAT(test::broken_pieces(model, set), IsEmpty());
    for (std::uint32_t p = 0; p < set.particle_count(); ++p) {
      const std::vector<std::uint32_t> members = set.members(p).value();
      for (const std::uint32_t point : members)
        EXPECT_EQ(set.positions()[point].z(), set.positions()[set.seed(p)].z());
    }
    for (std::uint32_t p = 0; p < set.particle_count(); ++p)
      for (const ParticleNeighbour& neighbour : set.neighbours(p))
        EXPECT_EQ(set.positions()[set.seed(neighbour.particle)].z(),
                  set.positions()[set.seed(p)].z());
  }
}

TEST(Decomposition, keeps_the_laws_on_anything) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(60, 50)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Character character = seed % 3 == 0 ? test::make_soup(random)
                          : seed % 3 == 1
                              ? test::make_two_tubes(3 + random.index(8), 4 + random.index(8))
                              : test::make_bumpy_ball(30 + random.index(500));
    const auto made = TornModel::create(std::make_shared<const Character>(std::move(character)));
    if (!made) continue;
    const ModelPose pose = test::random_pose(made->source(), random);
    const auto set = ParticleSet::create(*made, pose, {random.uniform(0.02, 1.2), true, seed});
    if (!set) {
      EXPECT_EQ(set.error().code(), StatusCode::empty_input) << set.error().text();
      continue;
    }
    ASSERT_THAT(test::broken_particles(*made, *set), IsEmpty());
    ASSERT_THAT(test::broken_pieces(*made, *set), IsEmpty());
    EXPECT_TRUE(set->lips().empty());
    for (std::uint32_t p = 0; p < set->particle_count(); ++p) {
      EXPECT_EQ(set->range(p), set->range(0));
      EXPECT_EQ(set->parents(p).weights, (std::array<float, 4>{}));
      EXPECT_TRUE(is_member(*set, set->seed(p), p));
    }
    const std::vector<test::PosedPoint> posed = test::posed_points(*made, *set, pose);
    for (std::uint32_t point = 0; point < set->point_count(); ++point) {
      if (made->surface().point_corner[point] == kNone || seed % 3 == 0)
        continue;  // soup has vertices that are at several points
      EXPECT_LT((posed[point].place - set->positions()[point].cast<double>()).norm(),
                1e-5 * (1 + posed[point].place.norm()));
      const auto memberships = set->memberships(point);
      EXPECT_TRUE(std::ranges::any_of(memberships, [](const ParticleMembership& of) {
        return double{of.reach} <= kCovers + 1e-6;
      }));
    }
  }
}

TEST(Decomposition, is_the_same_for_the_same_seed_only) {
  const TornModel model = make_model(test::make_tube(20, 20, 3));
  const ModelPose pose = *bind_pose(model.source());
  const auto state = [&](std::uint64_t seed) {
    return test::state_of(model, decompose(model, {0.1, true, seed}), pose);
  };
  const test::ParticleState first = state(5);
  EXPECT_EQ(test::difference(first, state(5)), "");
  std::size_t others = 0;
  for (std::uint64_t seed = 6; seed < 26; ++seed)
    others += test::difference(first, state(seed)).empty() ? 0 : 1;
  EXPECT_EQ(others, 20u);
}

/// The largest difference of a particle's weight between the ends of an edge, and the mean over the
/// edges of the largest difference.
struct Steps {
  double most = 0, mean = 0;
};

Steps steps_between_neighbours(std::uint32_t cells, std::uint64_t seed) {
  const TornModel model = make_model(test::make_sheet(cells));
  const ParticleSet set = decompose(model, {0.22, false, seed});
  const auto weight = [&](std::uint32_t point, std::uint32_t particle) {
    const ParticleInfluences& of = set.influences()[point];
    double sum = 0;
    for (std::uint32_t i = 0; i < 4; ++i)
      sum += of.particles[i] == particle ? double{of.weights[i]} : 0.0;
    return sum;
  };
  const tear::Surface& surface = model.surface();
  Steps steps;
  for (std::uint32_t c = 0; c < surface.corner_point.size(); ++c) {
    const std::uint32_t a = surface.corner_point[c],
                        b = surface.corner_point[tear::Surface::next(c)];
    double step = 0;
    for (const std::uint32_t end : {a, b})
      for (const std::uint32_t particle : set.influences()[end].particles)
        step = std::max(step, std::abs(weight(a, particle) - weight(b, particle)));
    steps.most = std::max(steps.most, step);
    steps.mean += step / static_cast<double>(surface.corner_point.size());
  }
  return steps;
}

TEST(Decomposition, has_weights_that_do_not_jump) {
  // Where the fifth particle becomes the fourth, or one ends, a jump would not decrease with the
  // edge length.
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(seed);
    Steps before;
    for (const std::uint32_t cells : {50u, 100u, 200u}) {
      SCOPED_TRACE(cells);
      const Steps steps = steps_between_neighbours(cells, seed);
      EXPECT_LT(steps.most, 20.0 / (0.22 * cells));
      if (before.mean > 0) {
        EXPECT_LT(steps.mean, 0.56 * before.mean);
      }
      before = steps;
    }
  }
}

TEST(Decomposition, has_weights_that_end_with_slope_zero) {
  // A share of (1 - reach^2)^2 <= 4 (1 - reach)^2, divided by that of a seed at the largest
  // possible distance.
  const double steepest = 1.1 * 4 / std::pow(1 - kCovers * kCovers, 2);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const TornModel model = make_model(test::make_sheet(60));
    const ParticleSet set = decompose(model, {0.2, false, seed});
    std::size_t looked_at = 0;
    for (std::uint32_t point = 0; point < set.point_count(); ++point) {
      const auto memberships = set.memberships(point);
      if (memberships.size() > 4) continue;  // the fifth is subtracted
      for (const ParticleMembership& of : memberships) {
        if (!(of.reach > 0.9f)) continue;
        const ParticleInfluences& influences = set.influences()[point];
        const auto at =
            std::ranges::find(influences.particles, of.particle) - influences.particles.begin();
        const double weight =
            at < 4 ? double{influences.weights[static_cast<std::size_t>(at)]} : 0.0;
        const double end = 1 - double{of.reach};
        EXPECT_LE(weight, steepest * end * end) << "at " << of.reach;
        ++looked_at;
      }
    }
    EXPECT_GT(looked_at, 100u);
  }
}

TEST(Decomposition, takes_ranges_as_a_part_of_the_diagonal_or_in_metres) {
  const TornModel model = make_model(test::make_sheet(20, 3.0f));
  const double diagonal = 3 * std::numbers::sqrt2;
  const ParticleSet part = decompose(model, {0.1, true, 3}),
                    metres = decompose(model, {0.1 * diagonal, false, 3});
  EXPECT_NEAR(part.report().range, 0.1 * diagonal, 1e-6);
  EXPECT_NEAR(part.range(0), metres.range(0), 1e-6);
  EXPECT_EQ(part.particle_count(), metres.particle_count());
  const ParticleSet one = decompose(model, {10.0, true, 0});
  EXPECT_EQ(one.particle_count(), 1u);
  EXPECT_EQ(one.influences()[0].weights[0], 1.0f);
  EXPECT_TRUE(one.neighbours(0).empty());
}

TEST(Decomposition, reports_its_results) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const TornModel model =
        make_model(seed % 2 == 0 ? test::make_two_tubes(9, 8) : test::make_sheet(12));
    const ParticleSet set = decompose(model, {random.uniform(0.05, 0.5), true, seed});
    const DecompositionReport& report = set.report();
    std::uint32_t most = 0, with_face = 0;
    std::uint64_t memberships = 0;
    for (std::uint32_t point = 0; point < set.point_count(); ++point) {
      const auto count = static_cast<std::uint32_t>(set.memberships(point).size());
      memberships += count;
      most = std::max(most, count);
      with_face += model.surface().point_corner[point] != kNone ? 1 : 0;
    }
    EXPECT_EQ(report.particles, set.particle_count());
    EXPECT_EQ(report.points, with_face);
    EXPECT_EQ(report.covered, with_face);
    EXPECT_EQ(report.memberships, memberships);
    EXPECT_EQ(report.most_memberships, most);
    EXPECT_NEAR(report.range, set.range(0), 1e-6 * report.range);
    EXPECT_GE(report.seconds, 0.0);
  }
}

TEST(Decomposition, refuses_ranges_that_are_none) {
  const TornModel model = make_model(test::make_sheet(4));
  for (const double range : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()})
    for (const bool is_fraction : {true, false}) {
      const auto set =
          ParticleSet::create(model, *bind_pose(model.source()), {range, is_fraction, 0});
      ASSERT_FALSE(set);
      EXPECT_EQ(set.error().code(), StatusCode::invalid_argument);
      EXPECT_THAT(std::string(set.error().text()), HasSubstr("range"));
    }
}

TEST(Decomposition, refuses_extreme_ranges_or_takes_them) {
  const TornModel model = make_model(test::make_sheet(4));
  for (const double range :
       {1e-300, 1.2e-38, 1e-37, 1e-35, 1e-33, 1e-30, 1e-12, 1e12, 1e30, 1e36, 1e38, 3.4e38, 1e300})
    for (const bool is_fraction : {true, false}) {
      SCOPED_TRACE(range);
      const auto set =
          ParticleSet::create(model, *bind_pose(model.source()), {range, is_fraction, 0});
      if (set) {
        EXPECT_THAT(test::broken_particles(model, *set), IsEmpty());
      } else {
        EXPECT_THAT(std::string(set.error().text()), HasSubstr("range"));
      }
    }
}

TEST(Decomposition, refuses_poses_that_do_not_fit) {
  const TornModel model = make_model(test::make_tube(5, 6, 3));
  const auto error = [&](const ModelPose& pose) {
    const auto set = ParticleSet::create(model, pose);
    EXPECT_FALSE(set);
    return set.error();
  };
  ModelPose pose = *bind_pose(model.source());
  pose.model_from_bone.pop_back();
  EXPECT_EQ(error(pose).code(), StatusCode::size_mismatch);
  EXPECT_THAT(std::string(error(pose).text()), HasSubstr("bones"));
  pose = *bind_pose(model.source());
  pose.morph_weights.push_back(0);
  EXPECT_EQ(error(pose).code(), StatusCode::size_mismatch);
  EXPECT_THAT(std::string(error(pose).text()), HasSubstr("morph"));
  pose = *bind_pose(model.source());
  pose.model_from_bone[1](0, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error(pose).code(), StatusCode::non_finite_value);
  EXPECT_EQ(error(pose).index(), 1u);
  EXPECT_THAT(std::string(error(pose).text()), HasSubstr("bone 1"));
  pose = *bind_pose(model.source());
  pose.morph_weights[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(error(pose).code(), StatusCode::non_finite_value);
  EXPECT_EQ(error(pose).index(), 0u);
}

TEST(Decomposition, refuses_a_model_without_a_face) {
  TornModel model = make_model(test::make_sheet(4));
  Bore bore;
  bore.origin = {0.5, 0.5, 1.0};
  bore.radius = 3.0;
  bore.depth = 2.0;
  ASSERT_TRUE(model.drill(*bind_pose(model.source()), bore));
  const auto set = ParticleSet::create(model, *bind_pose(model.source()));
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code(), StatusCode::empty_input);
  EXPECT_THAT(std::string(set.error().text()), HasSubstr("face"));
}

TEST(Decomposition, refuses_more_particles_than_there_may_be) {
  const TornModel model = make_model(test::make_sheet(1030));
  const auto set = ParticleSet::create(model, *bind_pose(model.source()), {1e-7, true, 0});
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().code(), StatusCode::limit_exceeded);
  EXPECT_THAT(std::string(set.error().text()), HasSubstr("1048576"));
}

TEST(Decomposition, of_a_torn_model_goes_around_the_tear) {
  TornModel model = make_model(test::make_sheet(15));
  const ModelPose pose = *bind_pose(model.source());
  ChangeRecord change;
  ASSERT_TRUE(
      model.tear(pose, Stroke{test::down_at(0.52, -0.2), test::down_at(0.52, 1.2)}, {}, &change));
  const ParticleSet set = decompose(model, {0.4, false, 0});
  EXPECT_THAT(test::broken_particles(model, set), IsEmpty());
  EXPECT_THAT(test::broken_pieces(model, set), IsEmpty());
  EXPECT_THAT(test::broken_sides(set, {&change, 1}), IsEmpty());
}

}  // namespace
}  // namespace sunder
