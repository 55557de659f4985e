// A fork that follows an operation on a replica gives the set the bits of following it at once.

#include <sunder/particles/particle_fork.h>
#include <sunder/tear/operation_job.h>
#include <sunder/tear/tear_stroke.h>

#include <thread>

#include "particles/soft_scene.h"
#include "support/models/random_operations.h"

namespace sunder {
namespace {

using test::Random;

/// A model with particles that share an asset.
struct Soft {
  TornModel model;
  ParticleSet set;

  Soft(const std::shared_ptr<const Character>& character,
       const std::shared_ptr<const ParticleAsset>& asset)
      : model(std::move(*TornModel::create(character))),
        set(std::move(*ParticleSet::create(asset, model))) {}
  void settle() {
    while (set.settle(model, 10'000)) {
    }
  }
};

struct Pair {
  std::shared_ptr<const Character> character;
  std::shared_ptr<const ParticleAsset> asset;
  Soft called, forked;

  explicit Pair(std::uint64_t seed)
      : character(make_character(seed)),
        asset(*ParticleAsset::create(*TornModel::create(character), *bind_pose(*character))),
        called(character, asset),
        forked(character, asset) {}
  static std::shared_ptr<const Character> make_character(std::uint64_t seed) {
    Random random(seed);
    return std::make_shared<const Character>(test::random_character(random));
  }
  void expect_same() {
    ASSERT_EQ(called.model.digest(), forked.model.digest());
    const auto wanted = called.set.save(), found = forked.set.save();
    ASSERT_EQ(wanted.has_value(), found.has_value());
    if (wanted) {
      ASSERT_EQ(*wanted, *found);
    }
    const auto gradients = called.set.gradients(called.model),
               others = forked.set.gradients(forked.model);
    ASSERT_EQ(gradients.size(), others.size());
    for (std::uint32_t point = 0; point < gradients.size(); ++point)
      if (called.set.influences()[point].weights[0] > 0) {
        ASSERT_EQ(gradients[point].of_weights, others[point].of_weights) << point;
      }
  }
};

/// Runs an operation as a job on another thread, and swaps it in. @return whether it succeeded.
bool run_forked(Soft& of, const Operation& operation) {
  auto fork = ParticleFork::create(of.set, of.model);
  EXPECT_TRUE(fork) << fork.error().text();
  Status followed;
  const auto job = OperationJob::create(
      of.model, operation, [&](const TornModel& replica, std::span<const ChangeRecord> changes) {
        followed = fork->follow(replica, changes);
      });
  EXPECT_TRUE(job) << job.error().text();
  std::thread worker([&] { job->run(); });
  const bool is_settled = !of.set.settle(of.model, 1000);  // as a frame meanwhile
  (void)of.set.gradients(of.model);
  worker.join();
  if (job->poll() == OperationJob::State::failed) return false;
  EXPECT_TRUE(is_settled);
  EXPECT_TRUE(followed) << followed.text();
  const std::uint64_t before = of.model.newest_operation();
  EXPECT_TRUE(job->swap_in(of.model));
  if (of.model.newest_operation() == before) return true;  // it missed
  const Status taken = fork->take(of.set, of.model);
  EXPECT_TRUE(taken) << taken.text();
  return true;
}

bool run_called(Soft& of, const Operation& operation) {
  std::vector<ChangeRecord> changes;
  const std::uint64_t before = of.model.newest_operation();
  if (!apply_operation(of.model, operation, &changes)) return false;
  if (of.model.newest_operation() == before) return true;
  EXPECT_TRUE(of.set.follow(of.model, changes));
  return true;
}

void step_history(Soft& of, bool is_undo) {
  ChangeRecord change;
  if (is_undo ? of.model.undo(&change) : of.model.redo(&change)) {
    EXPECT_TRUE(of.set.follow(of.model, {&change, 1}));
  }
}

TEST(particle_fork, gives_the_bits_of_following_at_once) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    SCOPED_TRACE(seed);
    Pair pair(seed);
    Random random(seed + 100);
    for (int i = 0; i < 10; ++i) {
      if (random.index(4) == 0) {
        const bool is_undo = random.index(2) == 0;
        step_history(pair.called, is_undo);
        step_history(pair.forked, is_undo);
      } else {
        const Operation operation = test::random_operation(pair.called.model, random);
        if (std::holds_alternative<UndoOperation>(operation) ||
            std::holds_alternative<RedoOperation>(operation))
          continue;
        ASSERT_EQ(run_called(pair.called, operation), run_forked(pair.forked, operation));
      }
      pair.called.settle();
      pair.forked.settle();
      ASSERT_NO_FATAL_FAILURE(pair.expect_same());
    }
  }
}

TEST(particle_fork, ends_when_the_set_changes) {
  Pair pair(3);
  Random random(1);
  auto fork = ParticleFork::create(pair.forked.set, pair.forked.model);
  ASSERT_TRUE(fork);
  while (pair.forked.model.newest_operation() == 0)
    (void)run_called(pair.forked, test::random_operation(pair.forked.model, random));
  const std::uint64_t revision = pair.forked.set.revision();
  EXPECT_EQ(fork->follow(pair.forked.model, {}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(fork->take(pair.forked.set, pair.forked.model).code(), StatusCode::invalid_argument);
  EXPECT_EQ(pair.forked.set.revision(), revision);
}

TEST(particle_fork, outlives_its_set) {
  auto pair = std::make_unique<Pair>(4);
  auto fork = ParticleFork::create(pair->forked.set, pair->forked.model);
  ASSERT_TRUE(fork);
  const TornModel replica = std::move(*TornModel::create(pair->character));
  pair.reset();
  EXPECT_EQ(fork->follow(replica, {}).code(), StatusCode::invalid_argument);
}

TEST(particle_fork, keeps_the_set_from_settling) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Pair pair(seed);
    Random random(seed);
    for (int i = 0; i < 20 && pair.forked.set.is_settled(); ++i)
      (void)run_called(pair.forked, test::random_operation(pair.forked.model, random));
    if (pair.forked.set.is_settled()) continue;
    const std::uint64_t revision = pair.forked.set.revision();
    {
      auto fork = ParticleFork::create(pair.forked.set, pair.forked.model);
      ASSERT_TRUE(fork);
      EXPECT_TRUE(pair.forked.set.settle(pair.forked.model));
      EXPECT_EQ(pair.forked.set.revision(), revision);
    }
    pair.forked.settle();
    EXPECT_GT(pair.forked.set.revision(), revision);
    return;
  }
  FAIL() << "no operation leaves work";
}

TEST(particle_fork, is_refused_in_a_stroke) {
  Pair pair(5);
  const Blade blade = {{0, 0, 9}, {0, 0, 0}};
  const auto stroke =
      TearStroke::create(pair.forked.model, *bind_pose(*pair.character), blade, {}, {});
  ASSERT_TRUE(stroke) << stroke.error().text();
  EXPECT_EQ(ParticleFork::create(pair.forked.set, pair.forked.model).error().code(),
            StatusCode::invalid_argument);
}

}  // namespace
}  // namespace sunder
