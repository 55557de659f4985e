// A cut that is limited to the sections near given places.
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/make_model.h"
#include "support/model_state.h"
#include "support/rigs.h"
#include "support/torn_invariants.h"

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

}  // namespace
}  // namespace sunder
