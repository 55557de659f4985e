// Particles follow every change of their model, and undo restores every bit of them.
#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/say.h"
#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/particle_laws.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::difference;
using test::down_at;
using test::make_model;
using test::ParticleState;
using test::Random;
using test::Sameness;
using test::state_of;
using testing::IsEmpty;

Character some_character(Random& random) {
  switch (random.index(8)) {
    case 0: return test::make_two_tubes(4 + random.index(6), 5 + random.index(8));
    case 1: return test::make_bumpy_ball(150 + random.index(300));
    default: return test::random_character(random);
  }
}

ParticleSet decompose(const TornModel& model, double range, std::uint64_t seed = 0) {
  auto set = ParticleSet::create(model, *bind_pose(model.source()), {range, true, seed});
  EXPECT_TRUE(set) << set.error().text();
  return std::move(*set);
}

void settle(const TornModel& model, ParticleSet& set, std::uint32_t points = 500) {
  while (set.settle(model, points)) {
  }
}

/// A model, its particles, and the records of the operations that are not undone.
struct Followed {
  TornModel model;
  ParticleSet set;
  std::vector<std::vector<ChangeRecord>> told = {};

  Followed(Character character, double range, std::uint64_t seed = 0)
      : model(make_model(std::move(character))), set(decompose(model, range, seed)) {}

  void expect_laws() const {
    ASSERT_THAT(test::broken_particles(model, set), IsEmpty());
    for (const auto& changes : told) ASSERT_THAT(test::broken_sides(set, changes), IsEmpty());
  }

  /// One call of the model, to be followed.
  template <class Call>
  void follow(Call call) {
    ChangeRecord change;
    const std::uint32_t before = model.undo_count();
    ASSERT_NO_FATAL_FAILURE(call(change));
    if (model.undo_count() == before) return;  // a miss
    const std::uint64_t revision = set.revision();
    const std::vector<ParticleInfluences> influences(set.influences().begin(),
                                                     set.influences().end());
    const Status status = set.follow(model, {&change, 1});
    ASSERT_TRUE(status) << status.text();
    EXPECT_GT(set.revision(), revision);
    expect_dirty(influences);
    told.push_back({std::move(change)});
  }
  void expect_dirty(const std::vector<ParticleInfluences>& before) const {
    for (std::uint32_t point = 0; point < set.point_count(); ++point) {
      if (point < before.size() && set.influences()[point] == before[point]) continue;
      if (point >= before.size() && model.surface().point_corner[point] == kNone)
        continue;  // was retired in the meantime
      ASSERT_TRUE(std::ranges::any_of(set.dirty_points(),
                                      [&](const IndexRange& range) {
                                        return point >= range.first &&
                                               point - range.first < range.count;
                                      }))
          << "point " << point << " changed";
    }
  }
  void play(const Operation& operation) {
    follow([&](ChangeRecord& change) {
      const auto report = test::play(model, operation, &change);
      ASSERT_TRUE(report) << report.error().text();
    });
  }
};

/// Points far enough from all recorded changes keep every bit. Far enough means: particles next to
/// the change reach a range to either side of their seeds, and a point that one of them leaves bare
/// gets another.
void expect_far_points_kept(const Followed& followed, const ParticleState& before) {
  const ParticleSet& set = followed.set;
  const auto first_new = static_cast<std::uint32_t>(before.memberships.size());
  std::vector<Vec3f> torn(set.positions().begin() + first_new, set.positions().end());
  for (const ChangeRecord& change : followed.told.back()) {
    for (const LipPair& pair : change.lips)
      torn.insert(torn.end(), {set.positions()[pair.left], set.positions()[pair.right]});
    for (const auto* side : {&change.rims.left, &change.rims.right})
      for (const std::uint32_t point : *side) torn.push_back(set.positions()[point]);
  }
  for (std::uint32_t point = 0; point < first_new; ++point)
    if (followed.model.surface().point_corner[point] == kNone)
      torn.push_back(set.positions()[point]);
  // Points next to a lip, as those on it, belong to particles that the tear passes.
  const tear::Surface& surface = followed.model.surface();
  float longest = 0;
  for (std::uint32_t c = 0; c < surface.corner_point.size(); ++c) {
    if (surface.has_repeated_point(c / 3)) continue;
    const std::uint32_t from = surface.corner_point[c],
                        to = surface.corner_point[tear::Surface::next(c)];
    longest = std::max(longest, (set.positions()[from] - set.positions()[to]).norm());
  }
  const auto reach = static_cast<float>(3.05 * set.report().range) + 2 * longest;
  for (std::uint32_t point = 0; point < first_new; ++point) {
    const Vec3f& at = set.positions()[point];
    if (std::ranges::any_of(torn, [&](const Vec3f& other) { return (other - at).norm() < reach; }))
      continue;
    const auto now = set.memberships(point);
    ASSERT_TRUE(std::ranges::equal(now, before.memberships[point],
                                   [](const ParticleMembership& a, const ParticleMembership& b) {
                                     return a.particle == b.particle && a.reach == b.reach;
                                   }))
        << "point " << point;
  }
}

void follow_at_random(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Character character = some_character(random);
  Followed followed(std::move(character), random.uniform(0.06, 0.4), seed);
  const ModelPose pose = test::random_pose(followed.model.source(), random);
  std::vector<ParticleState> states = {state_of(followed.model, followed.set, pose)};
  std::set<std::uint64_t> serials;
  for (const auto& particle : states[0].particles) serials.insert(particle.serial);
  for (int i = 0; i < 5; ++i) {
    SCOPED_TRACE(test::say("operation ", i));
    const std::size_t done = followed.told.size();
    ASSERT_NO_FATAL_FAILURE(followed.play(test::random_operation(followed.model, random)));
    if (followed.told.size() == done) continue;
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    settle(followed.model, followed.set, 1 + random.index(300));
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    ASSERT_NO_FATAL_FAILURE(expect_far_points_kept(followed, states.back()));
    states.push_back(state_of(followed.model, followed.set, pose));
    for (std::size_t p = states[done].particles.size(); p < states.back().particles.size(); ++p)
      EXPECT_TRUE(serials.insert(states.back().particles[p].serial).second)
          << "a number comes again";
  }
  ASSERT_EQ(followed.model.undo_count() + 1, states.size());

  std::size_t at = states.size() - 1;
  const auto go = [&](std::uint32_t steps, bool back) {
    for (std::uint32_t step = 0; step < steps; ++step)
      ASSERT_TRUE(back ? followed.model.undo() : followed.model.redo());
    at = back ? at - steps : at + steps;
    ChangeRecord change;  // records of undo and redo are not used
    ASSERT_TRUE(followed.set.follow(followed.model, {&change, 1}));
    ASSERT_EQ(difference(state_of(followed.model, followed.set, pose), states[at]), "")
        << "at operation " << at;
  };
  while (at > 0) ASSERT_NO_FATAL_FAILURE(go(1, true));
  while (at + 1 < states.size()) ASSERT_NO_FATAL_FAILURE(go(1, false));
  for (int i = 0; i < 10 && states.size() > 1; ++i) {  // back and forth, several steps at once
    const bool back = at + 1 == states.size() || (at > 0 && random.index(2) == 0);
    const auto most = static_cast<std::uint32_t>(back ? at : states.size() - 1 - at);
    ASSERT_NO_FATAL_FAILURE(go(1 + random.index(most), back));
  }
  // Operations after an undo have new serial numbers.
  const std::size_t particles = followed.set.particle_count();
  followed.told.resize(at);
  const std::size_t done = followed.told.size();
  ASSERT_NO_FATAL_FAILURE(followed.play(test::random_operation(followed.model, random)));
  settle(followed.model, followed.set);
  ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
  if (followed.told.size() == done) return;
  for (std::size_t p = particles; p < followed.set.particle_count(); ++p)
    EXPECT_TRUE(serials.insert(followed.set.serial(static_cast<std::uint32_t>(p))).second)
        << "a number comes again";
}

class RandomRepair : public testing::TestWithParam<int> {};

TEST_P(RandomRepair, keeps_the_laws_and_undo_gives_back_every_bit) {
  const int rounds = test::stressed(3, 17);
  for (int round = 0; round < rounds && !HasFailure(); ++round)
    follow_at_random(static_cast<std::uint64_t>(100 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomRepair, testing::Range(0, 100));

/// Calls follow one another, without frames that settle all the work between them.
void hurry_at_random(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Character character = some_character(random);
  Followed followed(std::move(character), random.uniform(0.1, 0.4), seed);
  const ModelPose pose = test::random_pose(followed.model.source(), random);
  const ParticleState first = state_of(followed.model, followed.set, pose);
  for (int i = 0; i < 6; ++i) {
    SCOPED_TRACE(test::say("operation ", i));
    ASSERT_NO_FATAL_FAILURE(followed.play(test::random_operation(followed.model, random)));
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    if (random.index(3) == 0) (void)followed.set.settle(followed.model, 1 + random.index(20));
    if (random.index(4) == 0 && followed.model.undo_count() > 0) {
      const std::uint32_t steps = 1 + random.index(followed.model.undo_count());
      for (std::uint32_t step = 0; step < steps; ++step) ASSERT_TRUE(followed.model.undo());
      followed.told.resize(followed.model.undo_count());
      ASSERT_TRUE(followed.set.follow(followed.model, {}));
      ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    }
  }
  settle(followed.model, followed.set);
  ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
  ASSERT_THAT(test::broken_rest(followed.model, followed.set, pose), IsEmpty());
  while (followed.model.undo_count() > 0) ASSERT_TRUE(followed.model.undo());
  ASSERT_TRUE(followed.set.follow(followed.model, {}));
  EXPECT_EQ(difference(state_of(followed.model, followed.set, pose), first), "");
}

class HurriedRepair : public testing::TestWithParam<int> {};

TEST_P(HurriedRepair, keeps_the_laws_where_nothing_settles_between_calls) {
  const int rounds = test::stressed(3, 17);
  for (int round = 0; round < rounds && !HasFailure(); ++round)
    hurry_at_random(static_cast<std::uint64_t>(100 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, HurriedRepair, testing::Range(0, 60));

TEST(Settle, gives_the_same_in_many_calls_as_in_one) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(40, 50)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed), again(seed);
    Followed at_once(some_character(random), 0.08 + 0.1 * static_cast<double>(seed % 4)),
        bit_by_bit(some_character(again), 0.08 + 0.1 * static_cast<double>(seed % 4));
    const ModelPose pose = test::random_pose(at_once.model.source(), random);
    Random budgets(seed);
    for (int i = 0; i < 3; ++i) {
      const Operation operation = test::random_operation(at_once.model, random);
      ASSERT_NO_FATAL_FAILURE(at_once.play(operation));
      settle(at_once.model, at_once.set, kNone);
      ASSERT_NO_FATAL_FAILURE(bit_by_bit.play(operation));
      while (bit_by_bit.set.settle(bit_by_bit.model, 1 + budgets.index(60)))
        ASSERT_THAT(test::broken_particles(bit_by_bit.model, bit_by_bit.set, false), IsEmpty());
      ASSERT_EQ(
          difference(state_of(at_once.model, at_once.set, pose),
                     state_of(bit_by_bit.model, bit_by_bit.set, pose), Sameness::but_for_sums),
          "")
          << "after operation " << i;
    }
  }
}

/// A stroke blade by blade, each extension followed.
void extend_at_random(std::uint64_t seed, bool settles) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Character character = some_character(random);
  Followed followed(std::move(character), random.uniform(0.06, 0.4), seed);
  TornModel& model = followed.model;
  ParticleSet& set = followed.set;
  const ModelPose some = test::random_pose(model.source(), random);
  const ParticleState before = state_of(model, set, some);
  const TearOperation tear = test::random_tear(model, random, seed % 2 == 1);
  const auto& pose = std::get<ModelPose>(tear.pose);
  {
    auto stroke = TearStroke::create(model, pose, tear.stroke[0], tear.options);
    ASSERT_TRUE(stroke) << stroke.error().text();
    followed.told.emplace_back();
    const auto follow = [&](const ChangeRecord& change) {
      const Status status = set.follow(model, {&change, 1});
      ASSERT_TRUE(status) << status.text();
      followed.told.back().push_back(change);
      ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
      if (settles) settle(model, set, 1 + random.index(100));
    };
    for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
      SCOPED_TRACE(test::say("blade ", i));
      ChangeRecord change;
      ASSERT_TRUE(stroke->extend(pose, tear.stroke[i], 0.0, &change));
      ASSERT_NO_FATAL_FAILURE(follow(change));
    }
    ChangeRecord change;
    ASSERT_TRUE(stroke->end(&change));
    ASSERT_NO_FATAL_FAILURE(follow(change));
  }
  settle(model, set);
  ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
  ASSERT_THAT(test::broken_rest(model, set, some), IsEmpty());
  if (model.undo_count() == 0) return;
  const ParticleState after = state_of(model, set, some);
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(set.follow(model, {}));
  ASSERT_EQ(difference(state_of(model, set, some), before), "");
  ASSERT_TRUE(model.redo());
  ASSERT_TRUE(set.follow(model, {}));
  ASSERT_EQ(difference(state_of(model, set, some), after), "");
}

class StrokeRepair : public testing::TestWithParam<int> {};

TEST_P(StrokeRepair, follows_every_extension) {
  extend_at_random(static_cast<std::uint64_t>(GetParam()), true);
}
TEST_P(StrokeRepair, follows_extensions_that_nothing_settles) {
  extend_at_random(static_cast<std::uint64_t>(GetParam()), false);
}

INSTANTIATE_TEST_SUITE_P(seeds, StrokeRepair, testing::Range(0, 40));

TEST(Follow, takes_a_stroke_that_is_cancelled) {
  for (const bool is_first : {true, false}) {
    Followed followed(test::make_sheet(12), 0.2, 0);
    TornModel& model = followed.model;
    ParticleSet& set = followed.set;
    const ModelPose pose = *rest_pose(model.source());
    if (!is_first) {
      ChangeRecord change;
      const std::array<Blade, 2> blades = {test::down_at(0.203, 0.3), test::down_at(0.203, 0.7)};
      ASSERT_TRUE(model.tear(pose, blades, {}, &change));
      ASSERT_TRUE(set.follow(model, {&change, 1}));
      settle(model, set);
    }
    const ParticleState before = state_of(model, set, pose);
    auto stroke = TearStroke::create(model, pose, test::down_at(0.503, 0.3));
    ASSERT_TRUE(stroke) << stroke.error().text();
    ChangeRecord change;
    ASSERT_TRUE(stroke->extend(pose, test::down_at(0.503, 0.7), 0.0, &change));
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    EXPECT_FALSE(set.lips().empty());
    ASSERT_TRUE(stroke->cancel(&change));
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    EXPECT_EQ(difference(state_of(model, set, pose), before), "")
        << (is_first ? "the first" : "a later one");
    EXPECT_TRUE(set.is_settled());
  }
}

TEST(Follow, takes_a_replayed_stroke_with_all_its_records) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(30, 20)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Followed followed(test::random_character(random), 0.2);
    const ModelPose some = test::random_pose(followed.model.source(), random);
    const ParticleState before = state_of(followed.model, followed.set, some);
    TearOperation tear = test::random_tear(followed.model, random, seed % 2 == 1);
    tear.pose_changes.push_back({static_cast<std::uint32_t>(tear.stroke.size() / 2),
                                 test::random_pose(followed.model.source(), random, 0.1)});
    if (tear.pose_changes[0].blade == 0) continue;
    std::vector<ChangeRecord> changes;
    const auto report = apply_operation(followed.model, tear, &changes);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_TRUE(followed.set.follow(followed.model, changes));
    followed.told.push_back(changes);
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    settle(followed.model, followed.set);
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    if (followed.model.undo_count() == 0) continue;
    ASSERT_TRUE(followed.model.undo());
    ASSERT_TRUE(followed.set.follow(followed.model, {}));
    EXPECT_EQ(difference(state_of(followed.model, followed.set, some), before), "");
  }
}

TEST(Follow, takes_layers_walls_and_caps) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(24, 20)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Followed followed(test::make_tube(8 + random.index(12), 8 + random.index(12), 3), 0.15, seed);
    const Character& source = followed.model.source();
    const ModelPose pose = *bind_pose(source);
    const double diagonal = test::posed_diagonal(source, pose);
    for (const Layers layers : {Layers::nearest, Layers::all})
      for (const double width : {0.0, 0.02})
        for (const double wall : {0.0, 0.03}) {
          TearOperation tear{pose, test::random_stroke(source, pose, random, 0.3, 3), {}, {}};
          tear.options.width = width * diagonal;
          tear.options.layers = layers;
          tear.options.wall_depth = wall * diagonal;
          for (Blade& blade : tear.stroke) blade.tip = blade.base + 5.0 * (blade.tip - blade.base);
          ASSERT_NO_FATAL_FAILURE(followed.play(tear));
          ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
          settle(followed.model, followed.set);
          ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
        }
    CutOperation cut{pose, {}};
    cut.cut.point = {0, 1.4, 0};
    cut.cut.normal = random.direction();
    cut.cut.caps = seed % 2 == 0;
    ASSERT_NO_FATAL_FAILURE(followed.play(cut));
    settle(followed.model, followed.set);
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    ASSERT_THAT(test::broken_rest(followed.model, followed.set, test::random_pose(source, random)),
                IsEmpty());
  }
}

/// Strokes on the unit sheet, down through it.
Stroke along(std::initializer_list<std::array<double, 2>> places) {
  Stroke stroke;
  for (const auto& place : places) stroke.push_back(down_at(place[0], place[1]));
  return stroke;
}

void follow_strokes(Followed& followed, const std::vector<Stroke>& strokes,
                    const TearOptions& options) {
  for (const Stroke& stroke : strokes) {
    ASSERT_NO_FATAL_FAILURE(
        followed.play(TearOperation{*bind_pose(followed.model.source()), stroke, {}, options}));
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
    settle(followed.model, followed.set, 40);
    ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
  }
}

TEST(Follow, takes_tears_that_cross_or_meet) {
  const std::vector<std::vector<Stroke>> all = {
      {along({{0.2, 0.51}, {0.83, 0.52}}), along({{0.52, 0.2}, {0.49, 0.81}})},  // X
      {along({{0.2, 0.51}, {0.83, 0.52}}), along({{0.52, 0.2}, {0.51, 0.52}})},  // T
      {along({{0.2, 0.51}, {0.83, 0.52}}), along({{0.52, 0.81}, {0.49, 0.6}, {0.48, 0.47}})},
      {along({{-0.1, 0.51}, {1.1, 0.52}}), along({{0.52, -0.2}, {0.49, 1.2}})},    // into quarters
      {along({{0.3, 0.3}, {0.7, 0.31}, {0.71, 0.68}, {0.32, 0.7}, {0.31, 0.2}})},  // a flap that
                                                                                   // comes free
      {along({{0.3, 0.3}, {0.7, 0.7}, {0.71, 0.3}, {0.31, 0.68}})},                // crosses itself
      {along({{0.2, 0.5}, {0.4, 0.51}}), along({{0.6, 0.49}, {0.8, 0.5}}),
       along({{0.38, 0.5}, {0.62, 0.5}})},  // joins two
      {along({{0.41, -0.1}, {0.42, 0.6}}), along({{0.61, -0.1}, {0.6, 0.6}}),
       along({{0.3, 0.5}, {0.7, 0.51}})},
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const double width : {0.0, 0.01, 0.06})
      for (const double range : {0.06, 0.15, 0.5})
        for (const std::uint32_t cells : {5u, 20u}) {
          SCOPED_TRACE(
              test::say("strokes ", i, ", width ", width, ", range ", range, ", cells ", cells));
          Followed followed(test::make_sheet(cells), range);
          TearOptions options;
          options.width = width;
          follow_strokes(followed, all[i], options);
          if (HasFatalFailure()) return;
          if (i >= 3 && i <= 4) {  // a free piece shares no particle with the rest
            const std::vector<std::uint32_t> pieces = test::pieces_of(followed.model);
            std::set<std::uint32_t> apart(pieces.begin(), pieces.end());
            apart.erase(kNone);
            EXPECT_GT(apart.size(), 1u);
          }
        }
}

TEST(Follow, takes_other_weights) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Followed followed(seed % 3 == 0 ? test::make_two_tubes(6, 8) : test::random_character(random),
                      0.2);
    ASSERT_NO_FATAL_FAILURE(followed.play(test::random_operation(followed.model, random)));
    settle(followed.model, followed.set);
    if (followed.model.undo_count() == 0) continue;
    const ModelPose pose = test::random_pose(followed.model.source(), random);
    const ParticleState before = state_of(followed.model, followed.set, pose);
    for (const WeightPolicy policy :
         {WeightPolicy::pose_exact, WeightPolicy::exact, WeightPolicy::barycentric}) {
      WeightsOperation wanted;
      wanted.weights.policy = policy;
      wanted.pose = test::random_pose(followed.model.source(), random);
      ChangeRecord change;
      const auto report = followed.model.reweigh(wanted, &change);
      ASSERT_TRUE(report) << report.error().text();
      ASSERT_TRUE(followed.set.follow(followed.model, {&change, 1}));
      ASSERT_NO_FATAL_FAILURE(followed.expect_laws());
      ASSERT_THAT(test::broken_rest(followed.model, followed.set, pose), IsEmpty())
          << weight_policy_name(policy);
    }
    ASSERT_NO_FATAL_FAILURE(followed.play(test::random_operation(followed.model, random)));
    settle(followed.model, followed.set);
    ASSERT_THAT(test::broken_rest(followed.model, followed.set, pose), IsEmpty());
    while (followed.model.undo_count() > 1) ASSERT_TRUE(followed.model.undo());
    ASSERT_TRUE(followed.set.follow(followed.model, {}));
    EXPECT_EQ(difference(state_of(followed.model, followed.set, pose), before), "");
  }
}

TEST(Follow, refuses_another_model_and_one_that_was_compacted) {
  Followed followed(test::make_sheet(8), 0.2);
  ASSERT_NO_FATAL_FAILURE(followed.play(TearOperation{
      *bind_pose(followed.model.source()), along({{0.2, 0.5}, {0.7, 0.52}}), {}, {}}));
  settle(followed.model, followed.set);
  const ModelPose pose = *bind_pose(followed.model.source());
  const ParticleState before = state_of(followed.model, followed.set, pose);
  const std::uint64_t revision = followed.set.revision();
  TornModel other = make_model(test::make_sheet(8));
  ChangeRecord change;
  ASSERT_TRUE(other.tear(pose, along({{0.2, 0.5}, {0.7, 0.52}}), {}, &change));
  const auto expect_refused = [&](const TornModel& model) {
    const Status status = followed.set.follow(model, {&change, 1});
    EXPECT_EQ(status.code(), StatusCode::invalid_argument);
    EXPECT_FALSE(status.text().empty());
    EXPECT_FALSE(followed.set.settle(model));
    EXPECT_EQ(followed.set.revision(), revision);
  };
  expect_refused(other);
  EXPECT_EQ(difference(state_of(followed.model, followed.set, pose), before), "");
  ASSERT_TRUE(followed.model.compact());
  expect_refused(followed.model);
  const auto anew = ParticleSet::create(followed.model, pose, {0.2});
  ASSERT_TRUE(anew) << anew.error().text();
  EXPECT_THAT(test::broken_particles(followed.model, *anew), IsEmpty());
}

TEST(Follow, of_a_call_that_did_nothing_changes_no_influence) {
  Followed followed(test::make_sheet(8), 0.2);
  const ModelPose pose = *bind_pose(followed.model.source());
  ASSERT_NO_FATAL_FAILURE(
      followed.play(TearOperation{pose, along({{0.2, 0.5}, {0.7, 0.52}}), {}, {}}));
  settle(followed.model, followed.set);
  const ParticleState before = state_of(followed.model, followed.set, pose);
  ChangeRecord change;
  ASSERT_TRUE(followed.model.tear(pose, along({{2.2, 0.5}, {2.7, 0.52}}), {}, &change));  // misses
  ASSERT_TRUE(followed.set.follow(followed.model, {&change, 1}));
  EXPECT_EQ(difference(state_of(followed.model, followed.set, pose), before), "");
}

// Squares of lengths underflow and overflow in single precision. Whatever a size leads to, it is a
// status.
TEST(Follow, tears_of_extreme_sizes) {
  for (int tenths = -260; tenths < 220; tenths += tenths < -200 ? 1 : 5) {
    SCOPED_TRACE(tenths);
    const double size = std::pow(10.0, 0.1 * tenths);
    TornModel model = make_model(test::make_sheet(8, static_cast<float>(size)));
    const ModelPose pose = *bind_pose(model.source());
    auto set = ParticleSet::create(model, pose, {0.2});
    if (!set) continue;
    ChangeRecord change;
    const auto blade = [&](double x, double y) {
      return Blade{Vec3d(x, y, 1) * size, Vec3d(x, y, -1) * size};
    };
    if (!model.tear(pose, std::vector{blade(0.2, 0.45), blade(0.7, 0.52)}, {}, &change)) continue;
    if (!set->follow(model, {&change, 1})) continue;
    settle(model, *set);
    EXPECT_GT(set->particle_count(), 0u);
  }
}

TEST(Settle, lists_only_points_whose_influences_changed) {
  bool has_changed = false, has_left_out = false;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Followed followed(test::make_bumpy_ball(1500), 0.3, seed);
    const ModelPose pose = *bind_pose(followed.model.source());
    ASSERT_NO_FATAL_FAILURE(followed.play(test::random_tear(followed.model, random, false)));
    for (bool is_left = followed.model.undo_count() > 0; is_left;) {
      const ParticleState before = state_of(followed.model, followed.set, pose);
      is_left = followed.set.settle(followed.model, 40);
      ASSERT_NO_FATAL_FAILURE(followed.expect_dirty(before.influences));
      const ParticleState now = state_of(followed.model, followed.set, pose);
      // A range may cover gaps, but begins and ends with a listed point.
      for (const auto& [first, count] : followed.set.dirty_points())
        for (const std::uint32_t end : {first, first + count - 1})
          EXPECT_NE(now.influences[end], before.influences[end]);
      has_changed |= now.influences != before.influences;
      for (std::size_t point = 0; point < now.influences.size(); ++point)
        has_left_out |= now.influences[point] == before.influences[point] &&
                        now.memberships[point].size() != before.memberships[point].size();
    }
  }
  EXPECT_TRUE(has_changed && has_left_out);
}

TEST(Settle, leaves_no_particle_in_two_pieces) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(100, 20)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::uint32_t fineness = 8 + random.index(12);
    Followed followed(seed % 3 == 0   ? test::make_sheet(fineness)
                      : seed % 3 == 1 ? test::make_tube(fineness, fineness, 3)
                                      : test::make_bumpy_ball(20 * fineness),
                      random.uniform(0.06, 0.4), seed);
    const ModelPose pose = *bind_pose(followed.model.source());
    const std::vector<Vec3d> positions = test::posed_positions(followed.model.source(), 0, pose);
    CutOperation cut{pose, {}};
    cut.cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
    cut.cut.normal = random.direction();
    cut.cut.caps = random.index(2) == 0;
    ASSERT_NO_FATAL_FAILURE(followed.play(cut));
    settle(followed.model, followed.set, 1 + random.index(300));
    ASSERT_THAT(test::broken_pieces(followed.model, followed.set), IsEmpty());
  }
}

void expect_lips_of_a_tear(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Followed followed(seed % 2 == 0 ? test::make_sheet(8 + random.index(12))
                                  : test::make_tube(10, 8 + random.index(12), 3),
                    0.2);
  const TearOperation tear = test::random_tear(followed.model, random, false);
  ASSERT_NO_FATAL_FAILURE(followed.play(tear));
  ASSERT_THAT(test::broken_lip_edges(followed.model, followed.set), IsEmpty());
  if (followed.model.undo_count() == 0) return;
  ASSERT_TRUE(followed.model.undo());
  ASSERT_TRUE(followed.set.follow(followed.model, {}));
  EXPECT_TRUE(followed.set.lips().empty());
}

TEST(Lips, are_the_borders_that_an_operation_made) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::stressed(60, 20)); ++seed)
    ASSERT_NO_FATAL_FAILURE(expect_lips_of_a_tear(seed));
}

/// Through the edge by which it left.
TEST(Lips, are_not_the_border_where_a_tear_comes_in_again) { expect_lips_of_a_tear(642); }

TEST(Lips, are_not_the_border_between_parts_of_a_stroke) {
  for (int seed = 0; seed < test::stressed(40, 20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    Followed followed(test::make_sheet(2 + random.index(12)), 0.2);
    TearOperation tear;
    tear.pose = *bind_pose(followed.model.source());
    for (int k = 0; k < 8; ++k)  // in and out of one side
      tear.stroke.push_back(
          test::down_at(0.1 + 0.1 * k, (k % 2 == 0 ? 1 : -1) * random.uniform(0.02, 0.2)));
    if (random.index(2) == 0) tear.options.width = random.uniform(0.001, 0.03);
    ASSERT_NO_FATAL_FAILURE(followed.play(tear));
    ASSERT_FALSE(followed.set.lips().empty());
    ASSERT_THAT(test::broken_lip_edges(followed.model, followed.set), IsEmpty());
  }
}

TEST(Lips, of_a_flat_tear_pull_apart_evenly) {
  for (const std::uint32_t cells : {4u, 9u, 25u}) {
    SCOPED_TRACE(cells);
    Followed followed(test::make_sheet(cells), 0.2);
    const ModelPose pose = *bind_pose(followed.model.source());
    const std::vector<Stroke> strokes = {along({{0.21, 0.5}, {0.72, 0.53}}),
                                         along({{-0.1, 0.2}, {0.6, 0.27}}),
                                         along({{0.45, 0.81}, {0.47, 0.12}})};
    for (const Stroke& stroke : strokes) {
      ASSERT_NO_FATAL_FAILURE(followed.play(TearOperation{pose, stroke, {}, {}}));
      ASSERT_FALSE(followed.set.lips().empty());
      Vec3d sum = Vec3d::Zero();
      for (const LipEdge& lip : followed.set.lips()) sum += lip.inward.cast<double>();
      EXPECT_LT(sum.norm(), 1e-5);
      // Edge by edge: from b on one lip to a on the other, as from a to b.
      std::map<std::uint32_t, std::set<std::uint32_t>> across;
      for (const auto& changes : followed.told)
        for (const ChangeRecord& change : changes)
          for (const LipPair& pair : change.lips) {
            across[pair.left].insert(pair.right);
            across[pair.right].insert(pair.left);
          }
      std::size_t pairs = 0;
      for (const LipEdge& a : followed.set.lips())
        for (const LipEdge& b : followed.set.lips())
          if (a.points[0] != a.points[1] && across[a.points[0]].contains(b.points[1]) &&
              across[a.points[1]].contains(b.points[0])) {
            const Vec3f left_over = a.inward + b.inward;
            EXPECT_LT(left_over.norm(), 1e-5f);
            ++pairs;
          }
      EXPECT_GT(pairs, 2u * cells / 4);
    }
    while (followed.model.undo_count() > 0) ASSERT_TRUE(followed.model.undo());
    ASSERT_TRUE(followed.set.follow(followed.model, {}));
    EXPECT_TRUE(followed.set.lips().empty());
  }
}

}  // namespace
}  // namespace sunder
