// Walls and caps of one name and material share a submesh, however many operations made them.

#include <sunder/tear/torn_model.h>

#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using ::testing::IsEmpty;

/// A short walled tear across the front of a tube of six bones.
Result<TearReport> tear_across(TornModel& model, double height, std::uint32_t material) {
  TearOptions options;
  options.wall_depth = 0.05;
  options.wall_material = material;
  const Stroke stroke = {{{-0.15, height, 1}, {-0.15, height, 0.2}},
                         {{0.15, height, 1}, {0.15, height, 0.2}}};
  return model.tear(*bind_pose(model.source()), stroke, options);
}

/// Walls and caps of this material, or of their rims'.
Operation with_material(Operation operation, std::uint32_t material) {
  if (auto* const tear = std::get_if<TearOperation>(&operation)) {
    tear->options.wall_depth = 0.05;
    tear->options.wall_material = material;
  } else if (auto* const cut = std::get_if<CutOperation>(&operation)) {
    cut->cut.caps = true;
    cut->cut.cap_material = material;
  } else if (auto* const bore = std::get_if<DrillOperation>(&operation)) {
    bore->bore.wall = true;
    bore->bore.wall_material = material;
  }
  return operation;
}

TEST(SharedSubmeshes, forty_walls_are_one) {
  TornModel model = make_model(test::make_tube(60, 24, 6));
  std::vector<test::ModelState> states = {test::state_of(model)};
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(tear_across(model, 0.3 + 0.13 * i, kNone));
    states.push_back(test::state_of(model));
  }
  const Mesh& mesh = model.character().meshes[0];
  EXPECT_EQ(mesh.submeshes.size(), model.source().meshes[0].submeshes.size() + 1);
  EXPECT_EQ(mesh.submeshes.back().name, "wall");
  EXPECT_GT(model.fillings(0).size(), 40u);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  for (std::size_t i = states.size() - 1; i-- > 0;) {
    ASSERT_TRUE(model.undo());
    ASSERT_EQ(test::difference(test::state_of(model), states[i]), "") << i;
  }
  for (std::size_t i = 1; i < states.size(); ++i) {
    ASSERT_TRUE(model.redo());
    ASSERT_EQ(test::difference(test::state_of(model), states[i]), "") << i;
  }
}

TEST(SharedSubmeshes, have_one_name_and_material_each) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::make_tube(12, 16, 3));
    std::vector<test::ModelState> states = {test::state_of(model)};
    for (int step = 0; step < 14; ++step) {
      if (random.index(3) == 0 && states.size() > 1) {  // the submeshes of what is undone vanish
        ASSERT_TRUE(model.undo());
        states.pop_back();
      } else {
        const std::uint32_t materials[] = {kNone, 3, 4}, before = model.undo_count();
        const Operation operation =
            with_material(test::random_operation(model, random), materials[random.index(3)]);
        ASSERT_TRUE(test::play(model, operation));
        if (model.undo_count() > before) states.push_back(test::state_of(model));
      }
      ASSERT_THAT(test::broken_laws(model), IsEmpty()) << step;
      ASSERT_EQ(test::difference(test::state_of(model), states.back()), "") << step;
    }
    TornModel again = make_model(model.source());
    const auto history = model.history();
    ASSERT_TRUE(history);
    for (const Operation& operation : *history) ASSERT_TRUE(test::play(again, operation));
    EXPECT_EQ(test::difference(test::state_of(again), states.back()), "");
  }
}

/// The digest numbers the walls of each operation as if they had a submesh of their own, as they
/// had in models that were made before submeshes were shared.
TEST(SharedSubmeshes, do_not_change_digests) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel shared = make_model(test::make_tube(12, 16, 3)),
              apart = make_model(test::make_tube(12, 16, 3));
    for (std::uint32_t step = 0; step < 6; ++step) {
      const Operation operation = test::random_operation(shared, random);
      if (std::holds_alternative<CutOperation>(operation)) continue;  // two caps share one anyway
      ASSERT_TRUE(test::play(shared, with_material(operation, 0)));
      ASSERT_TRUE(test::play(apart, with_material(operation, step)));
      ASSERT_EQ(shared.digest(), apart.digest()) << step;
    }
    const Mesh &a = shared.character().meshes[0], &b = apart.character().meshes[0];
    EXPECT_LE(a.submeshes.size(), 3u);
    EXPECT_GE(b.submeshes.size(), a.submeshes.size());
  }
}

}  // namespace
}  // namespace sunder
