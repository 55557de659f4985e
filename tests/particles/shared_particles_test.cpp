// Sets that share the decomposition of their character, and states that are saved and restored.

#include <sunder/particles/particle_fork.h>
#include <sunder/particles/soft_body.h>
#include <sunder/tear/tear_stroke.h>

#include <atomic>
#include <limits>
#include <thread>
#include <vector>

#include "particles/internal/body_copy.h"
#include "particles/soft_scene.h"
#include "support/models/random_operations.h"
#include "support/oracles/particle_laws.h"

namespace sunder {
namespace {

using test::difference;
using test::Random;
using test::state_of;

/// A soft character whose particles share an asset, or have a decomposition of their own.
struct Instance {
  std::unique_ptr<TornModel> model;
  std::unique_ptr<ParticleSet> set;
  std::unique_ptr<SoftBody> body;

  Instance(const std::shared_ptr<const Character>& character,
           const std::shared_ptr<const ParticleAsset>& asset, const ModelPose& pose)
      : model(std::make_unique<TornModel>(std::move(*TornModel::create(character)))) {
    auto made = asset ? ParticleSet::create(asset, *model) : ParticleSet::create(*model, pose);
    EXPECT_TRUE(made) << made.error().text();
    set = std::make_unique<ParticleSet>(std::move(*made));
    make_body(pose);
  }
  void make_body(const ModelPose& pose) {
    const SoftMaterial materials[2] = {*find_material("skin"), *find_material("fat")};
    auto soft = SoftBody::create(*set, pose, materials);
    EXPECT_TRUE(soft) << soft.error().text();
    EXPECT_TRUE(soft->set_tension({1.2, {}}));
    body = std::make_unique<SoftBody>(std::move(*soft));
  }
  void copy_body(const Instance& other) {
    body = std::make_unique<SoftBody>(particles::copy_body(*other.body, *set));
  }
};

/// One random call, the same for equal instances and generators. @return whether the model changed.
bool act(Instance& of, Random& random, const ModelPose& pose) {
  ChangeRecord change;
  bool is_changed = false;
  const std::uint32_t kind = random.index(8), particle = random.index(of.set->particle_count());
  const Vec3d direction = random.direction();
  const Operation operation = test::random_operation(*of.model, random);
  switch (kind) {
    case 0:
    case 1: is_changed = bool(test::play(*of.model, operation, &change)); break;
    case 2: is_changed = bool(of.model->undo(&change)); break;
    case 3: is_changed = bool(of.model->redo(&change)); break;
    case 4: EXPECT_TRUE(of.body->add_impulse(particle, 0.01 * direction)); break;
    case 5: EXPECT_TRUE(of.body->hold(particle, direction)); break;
    case 6: EXPECT_TRUE(of.body->set_material(particle, particle % 2)); break;
    default: (void)of.set->settle(*of.model, 30); break;
  }
  if (is_changed) {
    EXPECT_TRUE(of.set->follow(*of.model, {&change, 1}));
  }
  if (kind % 2 == 0) (void)of.set->gradients(*of.model);
  EXPECT_TRUE(of.body->step(
      *of.model, test::moved(pose, test::turn_by(0.1 * direction.x(), direction)), 1.0 / 60));
  return is_changed;
}

void expect_same(Instance& a, Instance& b, const ModelPose& pose) {
  ASSERT_EQ(difference(state_of(*a.model, *a.set, pose), state_of(*b.model, *b.set, pose)), "");
  ASSERT_EQ(a.body->particle_count(), b.body->particle_count());
  for (std::uint32_t p = 0; p < a.body->particle_count(); ++p) {
    ASSERT_EQ(a.body->displacement(p), b.body->displacement(p)) << p;
    ASSERT_EQ(a.body->velocity(p), b.body->velocity(p)) << p;
    ASSERT_EQ(a.body->place(p), b.body->place(p)) << p;
    ASSERT_EQ(a.body->is_awake(p), b.body->is_awake(p)) << p;
    ASSERT_EQ(a.body->material_of(p), b.body->material_of(p)) << p;
  }
  for (std::uint32_t mesh = 0; mesh < a.model->character().meshes.size(); ++mesh) {
    const auto ranges = a.body->moved_vertices(*a.model, mesh),
               others = b.body->moved_vertices(*b.model, mesh);
    ASSERT_TRUE(std::ranges::equal(ranges, others)) << mesh;
  }
  const auto gradients = a.set->gradients(*a.model), others = b.set->gradients(*b.model);
  ASSERT_EQ(gradients.size(), others.size());
  for (std::uint32_t point = 0; point < gradients.size(); ++point)
    if (a.set->influences()[point].weights[0] > 0) {
      ASSERT_EQ(gradients[point].of_weights, others[point].of_weights) << point;
    }
}

struct Shared {
  std::shared_ptr<const Character> character;
  ModelPose pose;
  std::shared_ptr<const ParticleAsset> asset;

  explicit Shared(Character from)
      : character(std::make_shared<const Character>(std::move(from))),
        pose(*bind_pose(*character)) {
    auto made = ParticleAsset::create(*TornModel::create(character), pose);
    EXPECT_TRUE(made) << made.error().text();
    asset = *made;
  }
};

TEST(shared_particles, have_the_bits_of_particles_of_their_own) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random of_character(seed);
    Character character = test::random_character(of_character);
    if (seed % 2 == 0)  // an asset without gradients
      for (Mesh& mesh : character.meshes) {
        mesh.normals.clear();
        mesh.tangents.clear();
      }
    const Shared shared(std::move(character));
    Instance own(shared.character, nullptr, shared.pose),
        first(shared.character, shared.asset, shared.pose),
        untouched(shared.character, shared.asset, shared.pose),
        copied(shared.character, shared.asset, shared.pose);
    copied.copy_body(untouched);
    const auto before = state_of(*untouched.model, *untouched.set, shared.pose);
    Random one(seed), other(seed), third(seed);
    for (int i = 0; i < 25; ++i) {
      (void)act(own, one, shared.pose);
      (void)act(first, other, shared.pose);
      (void)act(copied, third, shared.pose);
      ASSERT_NO_FATAL_FAILURE(expect_same(own, first, shared.pose));
      ASSERT_NO_FATAL_FAILURE(expect_same(own, copied, shared.pose));
    }
    ASSERT_EQ(difference(before, state_of(*untouched.model, *untouched.set, shared.pose)), "");
  }
}

TEST(shared_particles, cost_nothing_until_they_are_torn) {
  const Shared shared(test::make_bumpy_ball(4000));
  Instance instance(shared.character, shared.asset, shared.pose);
  EXPECT_LT(instance.set->memory_bytes(), 2048u);
  EXPECT_GT(shared.asset->memory_bytes(), 50u * instance.set->memory_bytes());
  const std::size_t before = instance.body->memory_bytes();
  EXPECT_LT(before, 1500u * instance.set->particle_count() + 4096);
  Random random(3);
  ChangeRecord change;
  while (!test::play(*instance.model, test::random_operation(*instance.model, random), &change) ||
         change.meshes.empty()) {
  }
  ASSERT_TRUE(instance.set->follow(*instance.model, {&change, 1}));
  EXPECT_GT(instance.set->memory_bytes(), 100u * instance.set->point_count());
}

TEST(shared_particles, take_no_more_memory_for_tears_that_are_undone) {
  const Shared shared(test::make_bumpy_ball(1000));
  Instance instance(shared.character, shared.asset, shared.pose);
  Random random(3);
  const auto tear_and_undo = [&] {
    Random again = random;  // the same tear each time
    ChangeRecord change;
    ASSERT_TRUE(
        test::play(*instance.model, test::random_tear(*instance.model, again, true), &change));
    ASSERT_TRUE(instance.set->follow(*instance.model, {&change, 1}));
    instance.set->settle(*instance.model, 1000);
    if (instance.model->undo_count() == 0) return;
    ASSERT_TRUE(instance.model->undo(&change));
    ASSERT_TRUE(instance.set->follow(*instance.model, {&change, 1}));
  };
  for (int i = 0; i < 50; ++i) tear_and_undo();
  const std::size_t before = instance.set->memory_bytes();
  for (int i = 0; i < 1000; ++i) tear_and_undo();
  EXPECT_LE(instance.set->memory_bytes(), before + before / 100);
}

TEST(shared_particles, refuse_other_models) {
  const Shared shared(test::make_sheet(6)), other(test::make_sheet(7));
  const TornModel model = std::move(*TornModel::create(other.character));
  EXPECT_EQ(ParticleSet::create(shared.asset, model).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(ParticleSet::create(nullptr, model).error().code(), StatusCode::empty_input);
}

/// Restores a copy of an instance beside it, with the operations replayed on the model.
void restore(const Shared& shared, const Instance& from, const ModelPose& pose, Instance& to) {
  for (const Operation& operation : *from.model->history())
    ASSERT_TRUE(apply_operation(*to.model, operation));
  const auto saved = from.set->save();
  ASSERT_TRUE(saved) << saved.error().text();
  auto restored = ParticleSet::restore(shared.asset, *to.model, *saved);
  ASSERT_TRUE(restored) << restored.error().text();
  EXPECT_EQ(*restored->save(), *saved);
  to.body.reset();
  to.set = std::make_unique<ParticleSet>(std::move(*restored));
  to.make_body(pose);
  const auto motion = from.body->save();
  ASSERT_TRUE(motion) << motion.error().text();
  const Status status = to.body->restore(*motion);
  ASSERT_TRUE(status) << status.text();
  EXPECT_EQ(*to.body->save(), *motion);
}

TEST(saved_particles, go_on_with_the_same_bits) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Random of_character(seed);
    const Shared shared(test::random_character(of_character));
    Instance first(shared.character, shared.asset, shared.pose),
        second(shared.character, shared.asset, shared.pose);
    Random random(seed);
    for (int i = 0; i < 15; ++i) (void)act(first, random, shared.pose);
    ASSERT_NO_FATAL_FAILURE(restore(shared, first, shared.pose, second));
    ASSERT_NO_FATAL_FAILURE(expect_same(first, second, shared.pose));
    Random one(seed + 100), other(seed + 100);
    for (int i = 0; i < 25; ++i) {
      // Operations that were undone before are not saved: its redo would be another operation.
      if (first.model->redo_count() > second.model->redo_count()) {
        ASSERT_TRUE(test::play(*first.model, test::random_operation(*first.model, one)));
        break;
      }
      (void)act(first, one, shared.pose);
      (void)act(second, other, shared.pose);
      ASSERT_NO_FATAL_FAILURE(expect_same(first, second, shared.pose));
    }
  }
}

TEST(saved_particles, go_on_while_the_surface_beside_a_lip_is_settled) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Shared shared(test::make_sheet(60));  // fine enough for small particles at lips
    Instance first(shared.character, shared.asset, shared.pose),
        second(shared.character, shared.asset, shared.pose);
    const double y = random.uniform(0.2, 0.8), slant = random.uniform(-0.1, 0.1);
    const Stroke stroke = {test::down_at(0.25, y), test::down_at(0.75, y + slant)};
    ChangeRecord change;
    ASSERT_TRUE(first.model->tear(shared.pose, stroke, {}, &change));
    ASSERT_TRUE(first.set->follow(*first.model, {&change, 1}));
    // The state is saved before the work that is left, in it, or at its end.
    ASSERT_TRUE(first.set->settle(*first.model, 1 + 90 * static_cast<std::uint32_t>(seed)));
    ASSERT_TRUE(first.body->step(*first.model, shared.pose, 1.0 / 60, 0));
    ASSERT_NO_FATAL_FAILURE(restore(shared, first, shared.pose, second));
    for (bool has_more = true; has_more;) {
      has_more = first.set->settle(*first.model, 100);
      ASSERT_EQ(second.set->settle(*second.model, 100), has_more);
      ASSERT_NO_FATAL_FAILURE(expect_same(first, second, shared.pose));
    }
  }
}

TEST(saved_particles, go_on_amid_the_points_of_one_particle) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Shared shared(test::random_character(random));
    Instance first(shared.character, shared.asset, shared.pose),
        second(shared.character, shared.asset, shared.pose);
    ChangeRecord change;
    if (!test::play(*first.model, test::random_operation(*first.model, random), &change)) continue;
    ASSERT_TRUE(first.set->follow(*first.model, {&change, 1}));
    for (std::uint32_t steps = random.index(60); steps > 0; --steps)
      (void)first.set->settle(*first.model, 2);
    ASSERT_TRUE(first.body->step(*first.model, shared.pose, 1.0 / 60, 0));
    ASSERT_NO_FATAL_FAILURE(restore(shared, first, shared.pose, second));
    for (bool has_more = true; has_more;) {
      has_more = first.set->settle(*first.model, 2);
      ASSERT_EQ(second.set->settle(*second.model, 2), has_more);
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(first, second, shared.pose));
  }
}

TEST(packed_particles, go_on_with_the_same_bits) {
  int packed = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random of_character(seed);
    Character character = test::random_character(of_character);
    if (seed % 3 == 0)  // an asset without gradients
      for (Mesh& mesh : character.meshes) mesh.normals.clear();
    const Shared shared(std::move(character));
    Instance kept(shared.character, shared.asset, shared.pose),
        packing(shared.character, shared.asset, shared.pose);
    Random one(seed), other(seed), when(seed);
    for (int i = 0; i < 40; ++i) {
      (void)act(kept, one, shared.pose);
      (void)act(packing, other, shared.pose);
      if (when.index(2) == 0) {  // nothing to do is left
        while (kept.set->settle(*kept.model, 1000)) {
        }
        while (packing.set->settle(*packing.model, 1000)) {
        }
      }
      const std::size_t before = packing.set->memory_bytes();
      ASSERT_TRUE(packing.set->pack());
      packed += packing.set->memory_bytes() < before;
      if (when.index(2) == 0 && kept.set->is_settled()) {
        ASSERT_EQ(*packing.set->save(), *kept.set->save());
      }
      if (when.index(3) == 0) {
        ASSERT_NO_FATAL_FAILURE(expect_same(kept, packing, shared.pose));
      }
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(kept, packing, shared.pose));
  }
  EXPECT_GT(packed, 400);
}

/// What can be read of the points of a set.
struct PointsOf {
  std::vector<ParticleInfluences> influences;
  std::vector<std::uint32_t> owners, vertex_points;
  std::vector<Vec3f> positions;

  explicit PointsOf(const ParticleSet& set)
      : influences(set.influences().begin(), set.influences().end()),
        owners(set.owners().begin(), set.owners().end()),
        vertex_points(set.vertex_points(0).begin(), set.vertex_points(0).end()),
        positions(set.positions().begin(), set.positions().end()) {}
  bool operator==(const PointsOf&) const = default;
};

TEST(packed_particles, take_memory_in_proportion_to_what_was_torn) {
  const Shared shared(test::make_sheet(150));  // 22,500 points
  Instance instance(shared.character, shared.asset, shared.pose);
  const Stroke stroke = {test::down_at(0.5, 0.5), test::down_at(0.52, 0.5)};
  ChangeRecord change;
  ASSERT_TRUE(instance.model->tear(shared.pose, stroke, {}, &change));
  ASSERT_TRUE(instance.set->follow(*instance.model, {&change, 1}));
  while (instance.set->settle(*instance.model, 1000)) {
  }
  (void)instance.set->gradients(*instance.model);
  const PointsOf before(*instance.set);
  std::size_t all = instance.set->memory_bytes();
  ASSERT_GT(all, 200u * instance.set->point_count());
  ASSERT_TRUE(instance.set->pack());
  EXPECT_LT(instance.set->memory_bytes(), all / 10);
  // It stays packed while particles are read, and while it is saved.
  (void)instance.set->save();
  (void)instance.set->is_settled();
  for (std::uint32_t p = 0; p < instance.set->particle_count(); ++p)
    (void)instance.set->neighbours(p);
  EXPECT_LT(instance.set->memory_bytes(), all / 10);
  std::vector<std::thread> readers;
  std::atomic<int> wrong = 0;
  for (int i = 0; i < 4; ++i)
    readers.emplace_back([&] { wrong += !(PointsOf(*instance.set) == before); });
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
}

TEST(packed_particles, wait_for_the_end_of_work) {
  const Shared shared(test::make_sheet(60));
  Instance instance(shared.character, shared.asset, shared.pose);
  const auto stays = [&] {
    const std::size_t before = instance.set->memory_bytes();
    EXPECT_TRUE(instance.set->pack());
    return instance.set->memory_bytes() == before;
  };
  EXPECT_TRUE(stays()) << "it shares all it has";
  const Stroke stroke = {test::down_at(0.25, 0.5), test::down_at(0.75, 0.5)};
  ChangeRecord change;
  ASSERT_TRUE(instance.model->tear(shared.pose, stroke, {}, &change));
  ASSERT_TRUE(instance.set->follow(*instance.model, {&change, 1}));
  ASSERT_FALSE(instance.set->is_settled());
  EXPECT_TRUE(stays()) << "there is work for settle()";
  while (instance.set->settle(*instance.model, 1000)) {
  }
  (void)instance.set->gradients(*instance.model);
  {
    auto fork = ParticleFork::create(*instance.set, *instance.model);
    ASSERT_TRUE(fork);
    EXPECT_TRUE(stays()) << "a fork may copy it";
  }
  EXPECT_FALSE(stays());
  Instance own(shared.character, nullptr, shared.pose);
  const std::size_t before = own.set->memory_bytes();
  EXPECT_TRUE(own.set->pack());
  EXPECT_EQ(own.set->memory_bytes(), before) << "it has no asset";
}

/// Replaces one number of a state by an odd one, or one from elsewhere.
StateArrays damaged(StateArrays state, Random& random) {
  constexpr std::uint32_t kOdd[] = {0, 1, 7, 1000, 0x7fffffff, kNone - 1, kNone};
  constexpr double kNumbers[] = {
      0.0, -1.0, 1e-30, 1.5, 1e9, -1e30, std::numeric_limits<double>::quiet_NaN()};
  const auto replace = [&](auto& values, auto odd) {
    const auto count = static_cast<std::uint32_t>(values.size());
    if (count == 0) return;
    auto& value = values[random.index(count)];
    value = random.index(3) == 0 ? values[random.index(count)]
                                 : static_cast<std::remove_reference_t<decltype(value)>>(odd);
  };
  switch (random.index(8)) {
    case 0:
    case 1: replace(state.floats, kNumbers[random.index(7)]); break;
    case 2:
    case 3: replace(state.doubles, kNumbers[random.index(7)]); break;
    case 4: replace(state.numbers, kOdd[random.index(7)]); break;
    case 5:
      state.indices[random.index(static_cast<std::uint32_t>(state.indices.size()))] += 1;
      break;
    default: replace(state.indices, kOdd[random.index(7)]);
  }
  return state;
}

/// What holds for a set and its body after any call. Restoring compares the cells of now with the
/// surface; of those to which undo leads only the range.
void expect_sound(const TornModel& model, const ParticleSet& set, SoftBody& body,
                  bool checks_cells) {
  const std::vector<std::string> faults = test::broken_particles(model, set, checks_cells);
  ASSERT_TRUE(faults.empty()) << faults[0];
  for (const Vec4f& displacement : body.displacements()) ASSERT_TRUE(displacement.allFinite());
  for (const Mat3f& turn : body.rotations()) ASSERT_TRUE(turn.allFinite());
}

/// Goes on with a set and a body, to all that undo and work that is left can reach.
void go_on(TornModel& model, ParticleSet& set, SoftBody& body, const ModelPose& pose,
           Random& random) {
  bool is_undone = false;
  const auto step = [&] {
    ASSERT_TRUE(body.step(model, pose, 1.0 / 60));
    (void)body.moved_vertices(model, 0);
    expect_sound(model, set, body, !is_undone);
  };
  ASSERT_NO_FATAL_FAILURE(expect_sound(model, set, body, true));
  ASSERT_NO_FATAL_FAILURE(step());
  while (set.settle(model)) {
  }
  ASSERT_NO_FATAL_FAILURE(step());
  ChangeRecord change;
  is_undone = true;
  const auto follow = [&](bool is_changed) {
    if (!is_changed) return;
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    ASSERT_NO_FATAL_FAILURE(step());
  };
  for (int i = 0; i < 2; ++i) ASSERT_NO_FATAL_FAILURE(follow(bool(model.undo(&change))));
  ASSERT_NO_FATAL_FAILURE(follow(bool(model.redo(&change))));
  ASSERT_NO_FATAL_FAILURE(
      follow(bool(test::play(model, test::random_operation(model, random), &change))));
  while (model.undo(&change)) ASSERT_NO_FATAL_FAILURE(follow(true));
}

/// Every number of a state is replaced by odd ones: the call fails, or what it makes keeps the laws
/// of particles, whatever is done next.
TEST(saved_particles, are_sound_or_refused) {
  Random random(5);
  int accepted = 0, refused = 0;
  for (int round = 0; round < 4; ++round) {
    const Shared shared(round % 2 == 0 ? test::make_tube(8, 9, 3) : test::make_sheet(24));
    Instance from(shared.character, shared.asset, shared.pose);
    for (int i = 0; i < 20; ++i) (void)act(from, random, shared.pose);
    const StateArrays set = *from.set->save(), body = *from.body->save();
    for (int i = 0; i < 250; ++i) {
      SCOPED_TRACE(testing::Message() << round << ", " << i);
      TornModel model = std::move(*TornModel::create(shared.character));
      for (const Operation& operation : *from.model->history())
        ASSERT_TRUE(apply_operation(model, operation));
      const bool is_of_set = random.index(3) > 0;
      auto restored =
          ParticleSet::restore(shared.asset, model, is_of_set ? damaged(set, random) : set);
      if (!restored) {
        ASSERT_TRUE(is_of_set) << restored.error().text();
        ++refused;
        continue;
      }
      const SoftMaterial materials[2] = {*find_material("skin"), *find_material("fat")};
      auto soft = SoftBody::create(*restored, shared.pose, materials);
      ASSERT_TRUE(soft);
      const StateArrays before = *soft->save();
      if (soft->restore(is_of_set ? body : damaged(body, random))) {
        ++accepted;
      } else {
        ++refused;
        ASSERT_EQ(*soft->save(), before);
      }
      ASSERT_NO_FATAL_FAILURE(go_on(model, *restored, *soft, shared.pose, random));
    }
  }
  EXPECT_GT(accepted, 20);
  EXPECT_GT(refused, 200);
}

/// A body on a decomposition of its own, with the motion of another at the same points.
TEST(soft_body, inherits_the_motion_of_another_body) {
  test::SoftScene from(test::make_tube(30, 16, 6), {}, 0.1),
      to(test::make_tube(30, 16, 6), {}, 0.08);
  for (std::uint32_t p = 0; p < from.count(); ++p)
    ASSERT_TRUE(from.body->add_impulse(p, Vec3d(1e-3, 0, 1e-3 * from.body->place(p).y())));
  from.run(0.1);
  std::vector<PointMotion> motions(to.set->point_count());
  for (std::uint32_t point = 0; point < motions.size(); ++point)
    motions[point] = motion_at(from.set->influences()[point], from.body->particle_motions());
  const Status status = to.body->inherit_motion_from(motions);
  ASSERT_TRUE(status) << status.text();
  double most = 0, error = 0;
  for (std::uint32_t point = 0; point < motions.size(); ++point) {
    most = std::max(most, from.body->point_displacement(point).norm());
    error = std::max(
        error, (from.body->point_displacement(point) - to.body->point_displacement(point)).norm());
  }
  EXPECT_GT(most, 1e-4);
  EXPECT_LT(error, 0.2 * most);
  EXPECT_GT(to.body->awake_count(), 0u);
  motions.pop_back();
  EXPECT_EQ(to.body->inherit_motion_from(motions).code(), StatusCode::size_mismatch);
}

}  // namespace
}  // namespace sunder
