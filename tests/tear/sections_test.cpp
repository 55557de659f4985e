// A cut that is limited to the sections near given places.
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::difference;
using test::make_model;
using test::Random;
using test::state_of;
using testing::IsEmpty;

/// Tubes side by side, each a mesh of its own with the same skin. Tube i stands at x = 2 i.
Character make_tubes_side_by_side(std::uint32_t count, std::uint32_t sides) {
  Character character = test::make_tube(6, sides, 3);
  const Mesh tube = character.meshes[0];
  const auto weights = static_cast<std::uint32_t>(character.rest_morph_weights.size());
  const std::vector<float> rest = character.rest_morph_weights;
  for (std::uint32_t i = 1; i < count; ++i) {
    Mesh mesh = tube;
    mesh.name += std::to_string(i);
    mesh.first_morph_weight = i * weights;
    for (Vec3f& position : mesh.positions) position.x() += 2 * static_cast<float>(i);
    character.meshes.push_back(mesh);
    character.rest_morph_weights.insert(character.rest_morph_weights.end(), rest.begin(),
                                        rest.end());
  }
  return character;
}

PlaneCut across_all() {
  PlaneCut cut;
  cut.point = Vec3d(0.0, 1.03, 0.0);
  cut.normal = Vec3d(0.05, 1.0, 0.02);
  cut.caps = true;
  return cut;
}

/// The meshes that differ from the source.
std::set<std::uint32_t> torn_meshes(const TornModel& model) {
  std::set<std::uint32_t> torn;
  for (std::uint32_t m = 0; m < model.source().meshes.size(); ++m)
    if (!(model.character().meshes[m] == model.source().meshes[m])) torn.insert(m);
  return torn;
}

TEST(Sections, only_the_named_tube_is_cut) {
  const Character tubes = make_tubes_side_by_side(3, 12);
  for (std::uint32_t wanted = 0; wanted < 3; ++wanted) {
    TornModel model = make_model(tubes);
    PlaneCut cut = across_all();
    cut.sections = {Vec3d(2.0 * wanted, 1.0, 0.2)};
    const auto report = model.cut(*bind_pose(tubes), cut);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->runs, 1u);
    EXPECT_EQ(report->caps, 2u);
    EXPECT_EQ(torn_meshes(model), std::set<std::uint32_t>{wanted});
    EXPECT_EQ(count_topology(model.character())->components, 4u);
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
  }
}

TEST(Sections, several_places_cut_their_own_sections) {
  const Character tubes = make_tubes_side_by_side(3, 12);
  TornModel model = make_model(tubes);
  PlaneCut cut = across_all();
  cut.sections = {Vec3d(4.1, 1.0, 0.0), Vec3d(-4.0, 0.0, 0.0), Vec3d(3.9, 1.1, 0.0)};
  ASSERT_TRUE(model.cut(*bind_pose(tubes), cut));
  EXPECT_EQ(torn_meshes(model), (std::set<std::uint32_t>{0, 2}));
}

TEST(Sections, a_place_of_each_section_cuts_as_no_place_does) {
  const Character tubes = make_tubes_side_by_side(3, 9);
  TornModel with = make_model(tubes), without = make_model(tubes);
  PlaneCut cut = across_all();
  ASSERT_TRUE(without.cut(*bind_pose(tubes), cut));
  cut.sections = {Vec3d(0, 1, 0), Vec3d(2, 1, 0), Vec3d(4, 1, 0)};
  ASSERT_TRUE(with.cut(*bind_pose(tubes), cut));
  EXPECT_EQ(difference(state_of(with), state_of(without)), "");
}

TEST(Sections, of_coincident_surfaces_are_cut_together) {
  Character doubled = make_tubes_side_by_side(2, 12);
  doubled.meshes[1].positions = doubled.meshes[0].positions;
  // Another morph target, so that its points are not joined with those of the first tube.
  for (Vec3f& delta : doubled.meshes[1].morph_targets[0].position_deltas) delta *= 2;
  TornModel model = make_model(doubled);
  PlaneCut cut = across_all();
  cut.sections = {Vec3d(5, 1, 0)};
  const auto report = model.cut(*bind_pose(doubled), cut);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->runs, 2u);
}

TEST(Sections, are_limited_by_the_bounds) {
  const Character tubes = make_tubes_side_by_side(2, 16);
  TornModel model = make_model(tubes);
  PlaneCut cut = across_all();
  // The bounds leave out the first tube: the nearest section within them is the second one's.
  cut.bounds = {Vec3d(1, 1, -2), Vec3d(3, 1, -2), Vec3d(3, 1, 2), Vec3d(1, 1, 2)};
  cut.sections = {Vec3d(0, 1, 0)};
  const auto report = model.cut(*bind_pose(tubes), cut);
  ASSERT_TRUE(report);
  EXPECT_EQ(torn_meshes(model), std::set<std::uint32_t>{1});

  // Bounds that leave a front and a back part of a tube: two sections.
  TornModel parted = make_model(tubes);
  cut.bounds = {Vec3d(-0.05, 1, -2), Vec3d(0.05, 1, -2), Vec3d(0.05, 1, 2), Vec3d(-0.05, 1, 2)};
  cut.sections = {Vec3d(0, 1, 2)};
  cut.caps = false;
  const auto front = parted.cut(*bind_pose(tubes), cut);
  ASSERT_TRUE(front);
  EXPECT_EQ(front->runs, 1u);
  cut.sections.clear();
  TornModel both = make_model(tubes);
  const auto all = both.cut(*bind_pose(tubes), cut);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->runs, 2u);
}

TEST(Sections, that_are_not_finite_or_too_far_are_refused) {
  TornModel model = make_model(make_tubes_side_by_side(2, 6));
  const auto before = state_of(model);
  PlaneCut cut = across_all();
  cut.sections = {Vec3d(0, 0, 0), Vec3d(0, std::numeric_limits<double>::quiet_NaN(), 0)};
  const auto not_finite = model.cut(*bind_pose(model.source()), cut);
  ASSERT_FALSE(not_finite);
  EXPECT_EQ(not_finite.error().code(), StatusCode::non_finite_value);
  EXPECT_EQ(not_finite.error().index(), 1u);
  cut.sections = {Vec3d(0, 1e61, 0)};
  const auto far_away = model.cut(*bind_pose(model.source()), cut);
  ASSERT_FALSE(far_away);
  EXPECT_EQ(far_away.error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(difference(state_of(model), before), "");
}

TEST(Sections, at_random_are_replayed_and_undone_bit_for_bit) {
  Random random(22);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Character tubes = make_tubes_side_by_side(2 + random.index(3), 5 + random.index(12));
    TornModel model = make_model(tubes);
    for (int k = 0; k < 3; ++k) {
      const auto before = state_of(model);
      PlaneCut cut;
      cut.point = Vec3d(random.uniform(0, 2), random.uniform(0.3, 1.7), 0);
      cut.normal = random.direction() + Vec3d(0, 1.2, 0);
      cut.caps = random.index(2) == 0;
      cut.sections = {Vec3d(random.uniform(-1, 7), random.uniform(0, 2), random.uniform(-1, 1))};
      const ModelPose pose = test::random_pose(tubes, random, 0.3, 1.0);
      const auto report = model.cut(pose, cut);
      ASSERT_TRUE(report) << report.error().text();
      if (report->runs == 0) continue;
      ASSERT_THAT(test::broken_laws(model), IsEmpty());
      const auto after = state_of(model);
      ASSERT_TRUE(model.undo());
      ASSERT_EQ(difference(state_of(model), before), "");
      ASSERT_TRUE(model.redo());
      ASSERT_EQ(difference(state_of(model), after), "");
    }
    TornModel again = make_model(tubes);
    const auto history = model.history();
    ASSERT_TRUE(history);
    for (const Operation& operation : *history) {
      EXPECT_EQ(std::get<CutOperation>(operation).cut.sections.size(), 1u);
      ASSERT_TRUE(apply_operation(again, operation));
    }
    EXPECT_EQ(again.digest(), model.digest());
  }
}

TEST(Sections, only_the_first_on_a_ray_is_cut) {
  const Character tubes = make_tubes_side_by_side(3, 12);
  const auto torn_by = [&](const Vec3d& origin, const Vec3d& direction) {
    TornModel model = make_model(tubes);
    PlaneCut cut = across_all();
    cut.first_hit = {origin, direction};
    const auto report = model.cut(*bind_pose(tubes), cut);
    EXPECT_TRUE(report) << report.error().text();
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
    return torn_meshes(model);
  };
  using Meshes = std::set<std::uint32_t>;
  EXPECT_EQ(torn_by({-5, 1, 0}, {1, 0, 0}), Meshes{0});
  EXPECT_EQ(torn_by({-5, 7, 0}, {2, -1, 0}), Meshes{0}) << "projected onto the plane";
  EXPECT_EQ(torn_by({1, 1, 0}, {1, 0, 0}), Meshes{1});
  EXPECT_EQ(torn_by({3, 1, 0}, {-1, 0, 0}), Meshes{1});
  EXPECT_EQ(torn_by({4, 1, 0}, {0, 0, 1}), Meshes{2}) << "from within";
  EXPECT_EQ(torn_by({6, 1, 0}, {1, 0, 0}), Meshes{}) << "a ray that meets none";
}

TEST(Sections, the_first_on_a_ray_is_the_nearest_crossing_of_all_triangles) {
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const Character tubes = make_tubes_side_by_side(3, 5 + random.index(12));
    const ModelPose pose = test::random_pose(tubes, random, 0.3, 1.0);
    PlaneCut cut;
    cut.point = Vec3d(random.uniform(0, 2), random.uniform(0.3, 1.7), 0);
    cut.normal = Vec3d(random.direction() + Vec3d(0, 1.2, 0)).normalized();
    cut.first_hit = {Vec3d(random.uniform(-2, 6), 1, random.uniform(-2, 2)), random.direction()};
    // Per mesh, the nearest crossing of the ray's projection with a triangle's line in the plane.
    const Vec3d along =
        Vec3d(cut.first_hit->direction - cut.normal.dot(cut.first_hit->direction) * cut.normal)
            .normalized();
    const Vec3d across = cut.normal.cross(along);
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = kNone;
    for (std::uint32_t m = 0; m < 3; ++m) {
      const auto places = test::posed_positions(tubes, m, pose);
      for (const Triangle& triangle : tubes.meshes[m].triangles) {
        std::vector<Vec3d> ends;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3d &a = places[triangle[k]], &b = places[triangle[(k + 1) % 3]];
          const double at_a = cut.normal.dot(a - cut.point), at_b = cut.normal.dot(b - cut.point);
          if ((at_a < 0) != (at_b < 0)) ends.emplace_back(a + at_a / (at_a - at_b) * (b - a));
        }
        if (ends.size() != 2) continue;
        const double left = across.dot(ends[0] - cut.first_hit->origin),
                     right = across.dot(ends[1] - cut.first_hit->origin);
        if ((left < 0) == (right < 0)) continue;
        const Vec3d place = ends[0] + left / (left - right) * (ends[1] - ends[0]);
        const double distance = along.dot(place - cut.first_hit->origin);
        if (distance < 0 || distance >= least) continue;
        least = distance;
        nearest = m;
      }
    }
    TornModel model = make_model(tubes);
    const auto report = model.cut(pose, cut);
    ASSERT_TRUE(report) << report.error().text();
    if (nearest == kNone) {
      EXPECT_EQ(report->runs, 0u);
      continue;
    }
    ++hits;
    EXPECT_EQ(torn_meshes(model), std::set<std::uint32_t>{nearest});
  }
  EXPECT_GT(hits, 30);
}

/// Tubes of which one is moved by the last bone of the chain, the others by the first.
Character make_tubes_with_limb(std::uint32_t limb) {
  Character tubes = make_tubes_side_by_side(3, 12);
  for (Mesh& mesh : tubes.meshes) {
    SkinWeights rigid;
    rigid.first = {0};
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      rigid.influences.push_back({&mesh == &tubes.meshes[limb] ? 2u : 0u, 1.0f});
      rigid.first.push_back(v + 1);
    }
    mesh.weights = rigid;
  }
  return tubes;
}

TEST(Sections, only_those_that_a_bones_subtree_moves_are_cut) {
  for (std::uint32_t limb = 0; limb < 3; ++limb) {
    const Character tubes = make_tubes_with_limb(limb);
    PlaneCut cut = across_all();
    const auto torn_under = [&](std::uint32_t bone) {
      TornModel model = make_model(tubes);
      cut.bone = tubes.skeleton.bones[tubes.skins[0].bones[bone]].name;
      const auto report = model.cut(*bind_pose(tubes), cut);
      EXPECT_TRUE(report) << report.error().text();
      return torn_meshes(model);
    };
    EXPECT_EQ(torn_under(2), std::set<std::uint32_t>{limb});
    EXPECT_EQ(torn_under(1), std::set<std::uint32_t>{limb});
    EXPECT_EQ(torn_under(0), (std::set<std::uint32_t>{0, 1, 2}));
    // The ray and the places choose among the sections of the subtree.
    cut.first_hit = {Vec3d(-5, 1, 0), Vec3d(1, 0, 0)};
    EXPECT_EQ(torn_under(2), std::set<std::uint32_t>{limb});
  }
}

TEST(Sections, limits_that_say_nothing_are_refused) {
  TornModel model = make_model(make_tubes_side_by_side(2, 6));
  const auto before = state_of(model);
  const auto code_of = [&](const PlaneCut& cut) {
    const auto report = model.cut(*bind_pose(model.source()), cut);
    return report ? StatusCode::ok : report.error().code();
  };
  PlaneCut cut = across_all();
  cut.bone = "no bone";
  EXPECT_EQ(code_of(cut), StatusCode::not_found);
  cut.bone.clear();
  cut.first_hit = {Vec3d::Zero(), cut.normal};
  EXPECT_EQ(code_of(cut), StatusCode::invalid_argument) << "a ray across the plane";
  cut.first_hit = {Vec3d::Zero(), Vec3d::Zero()};
  EXPECT_EQ(code_of(cut), StatusCode::invalid_argument);
  cut.first_hit = {Vec3d(0, std::numeric_limits<double>::infinity(), 0), Vec3d(1, 0, 0)};
  EXPECT_EQ(code_of(cut), StatusCode::non_finite_value);
  EXPECT_EQ(difference(state_of(model), before), "");
}

}  // namespace
}  // namespace sunder
