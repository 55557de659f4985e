// Models of one asset: they share what they have in common, do not influence each other, and take
// memory in proportion to what was torn.
#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/say.h"
#include "support/machine/starve.h"
#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::difference;
using test::live_bytes;
using test::Random;
using test::state_of;
using testing::IsEmpty;

std::shared_ptr<const TornAsset> make_asset(Character character) {
  auto asset = TornAsset::create(std::make_shared<const Character>(std::move(character)));
  EXPECT_TRUE(asset) << asset.error().text();
  return *asset;
}

TornModel model_of(const std::shared_ptr<const TornAsset>& asset,
                   const TornCapacity& capacity = {}) {
  auto model = TornModel::create(asset, capacity);
  EXPECT_TRUE(model) << model.error().text();
  return std::move(*model);
}

/// Does something at random, the same for equal generators and models in equal states.
void act(TornModel& model, Random& random) {
  switch (random.index(8)) {
    case 0: (void)model.undo(); break;
    case 1: (void)model.redo(); break;
    case 2: {
      WeightsOperation operation;
      operation.weights.policy =
          random.index(2) == 0 ? WeightPolicy::exact : WeightPolicy::pose_exact;
      if (model.undo_count() > 0) (void)model.reweigh(operation);
      break;
    }
    case 3: {
      const ModelPose pose = test::random_pose(model.source(), random);
      const Stroke blades = test::random_stroke(model.source(), pose, random);
      auto stroke = TearStroke::create(model, pose, blades[0]);
      ASSERT_TRUE(stroke) << stroke.error().text();
      for (std::size_t i = 1; i < blades.size(); ++i) (void)stroke->extend(pose, blades[i]);
      ASSERT_TRUE(random.index(3) == 0 ? stroke->cancel() : test::status_of(stroke->end()));
      break;
    }
    default: {
      const auto report = test::play(model, test::random_operation(model, random));
      ASSERT_TRUE(report) << report.error().text();
    }
  }
}

/// All that a model tells.
std::string difference_of(const TornModel& a, const TornModel& b) {
  if (a.undo_count() != b.undo_count()) return "undo count";
  if (a.redo_count() != b.redo_count()) return "redo count";
  if (a.history()->size() != b.history()->size()) return "history";
  if (a.weights() != b.weights()) return "weight options";
  return difference(state_of(a), state_of(b));
}

/// A model of an asset, and one that has everything alone.
struct Pair {
  explicit Pair(const std::shared_ptr<const TornAsset>& asset, std::uint64_t seed)
      : sharing(model_of(asset)),
        alone(*TornModel::create(asset->character())),
        of_sharing(seed),
        of_alone(seed) {}

  TornModel sharing, alone;
  Random of_sharing, of_alone;
};

class RandomModels : public testing::TestWithParam<int> {};

TEST_P(RandomModels, of_one_asset_do_not_influence_each_other) {
  const int rounds = test::stressed(1, 50);
  for (int round = 0; round < rounds && !HasFailure(); ++round) {
    const auto seed = static_cast<std::uint64_t>(100 * round + GetParam());
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto asset =
        make_asset(seed % 4 == 0 ? test::make_two_tubes(4, 6) : test::random_character(random));
    ASSERT_TRUE(asset->prepare(random.index(3)));
    std::vector<std::unique_ptr<Pair>> pairs;
    for (std::uint64_t i = 0; i < 3; ++i)
      pairs.push_back(std::make_unique<Pair>(asset, 1000 * seed + i));
    for (int step = 0; step < 24; ++step) {
      Pair& pair = *pairs[random.index(3)];
      ASSERT_NO_FATAL_FAILURE(act(pair.sharing, pair.of_sharing));
      ASSERT_NO_FATAL_FAILURE(act(pair.alone, pair.of_alone));
      if (random.index(2) == 0) {
        ASSERT_TRUE(pairs[random.index(3)]->sharing.pack());
      }
    }
    for (const auto& pair : pairs) {
      ASSERT_EQ(difference_of(pair->sharing, pair->alone), "");
      EXPECT_THAT(test::broken_laws(pair->sharing), IsEmpty());
      while (pair->alone.undo_count() > 0) {
        if (random.index(2) == 0) {
          ASSERT_TRUE(pair->sharing.pack());
        }
        ASSERT_TRUE(pair->sharing.undo());
        ASSERT_TRUE(pair->alone.undo());
        ASSERT_EQ(difference_of(pair->sharing, pair->alone), "");
      }
      EXPECT_EQ(pair->sharing.character(), pair->sharing.source());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomModels, testing::Range(0, 40));

TEST(TornAsset, models_that_nothing_has_torn_answer_like_others) {
  const auto asset = make_asset(test::make_two_tubes(4, 6));
  TornModel sharing = model_of(asset), alone = *TornModel::create(asset->character());
  EXPECT_EQ(difference_of(sharing, alone), "");
  EXPECT_EQ(&sharing.character(), asset->character().get());
  EXPECT_EQ(sharing.weight_policy(1, 3), WeightPolicy::barycentric);
  EXPECT_EQ(sharing.influence_place(1, 3), kNone);
  EXPECT_TRUE(sharing.influence_positions(0).vertices.empty());
  EXPECT_EQ(sharing.undo().code(), StatusCode::not_found);
  EXPECT_EQ(sharing.redo().code(), StatusCode::not_found);
  EXPECT_FALSE(sharing.is_in_stroke());
  EXPECT_EQ(sharing.newest_operation(), 0u);
  TornModel moved = std::move(sharing);
  EXPECT_EQ(difference_of(moved, alone), "");
  TornModel assigned = *TornModel::create(make_asset(test::make_sheet(2)));
  assigned = std::move(moved);
  EXPECT_EQ(difference_of(assigned, alone), "");
}

TEST(TornAsset, refuses_what_models_refuse) {
  EXPECT_EQ(TornAsset::create(nullptr).error().code(), StatusCode::empty_input);
  EXPECT_EQ(TornModel::create(std::shared_ptr<const TornAsset>()).error().code(),
            StatusCode::empty_input);
  Character broken = test::make_sheet(2);
  broken.meshes[0].triangles[1][0] = 1000;
  const auto shared = std::make_shared<const Character>(broken);
  EXPECT_EQ(TornAsset::create(shared).error().text(), TornModel::create(shared).error().text());
  const auto asset = make_asset(test::make_sheet(2));
  const TornCapacity huge{1, kNone / 3, 1};
  EXPECT_EQ(TornModel::create(asset, huge).error().code(), StatusCode::limit_exceeded);
  EXPECT_EQ(asset->prepare(1, huge).code(), StatusCode::limit_exceeded);
}

TEST(TornAsset, a_model_in_a_stroke_is_not_packed) {
  const auto asset = make_asset(test::make_sheet(6));
  TornModel model = model_of(asset);
  const ModelPose pose = *bind_pose(model.source());
  auto stroke = TearStroke::create(model, pose, test::down_at(0.2, 0.2));
  ASSERT_TRUE(stroke);
  EXPECT_EQ(model.pack().code(), StatusCode::invalid_argument);
  EXPECT_FALSE(model.is_packed());
  ASSERT_TRUE(stroke->extend(pose, test::down_at(0.6, 0.3)));
  ASSERT_TRUE(stroke->end());
  const test::ModelState state = state_of(model);
  ASSERT_TRUE(model.pack());
  EXPECT_TRUE(model.is_packed());
  EXPECT_FALSE(model.is_in_stroke());
  ASSERT_TRUE(model.unpack());
  EXPECT_FALSE(model.is_packed());
  EXPECT_EQ(difference(state, state_of(model)), "");
}

TEST(TornAsset, a_refit_survives_packing) {
  const auto asset = make_asset(test::make_tube(6, 8, 3));
  TornModel model = model_of(asset);
  Random random(3);
  ASSERT_TRUE(test::play(model, test::random_tear(model, random, false)));
  WeightsOperation wanted;
  wanted.weights.policy = WeightPolicy::refit;
  const auto job = RefitJob::create(model, wanted);
  ASSERT_TRUE(job) << job.error().text();
  ASSERT_TRUE(model.pack());
  job->run();
  ASSERT_TRUE(job->swap_in(model));
  ASSERT_TRUE(model.pack());
  EXPECT_EQ(model.undo_count(), 2u);

  // Undoing an operation cancels the refits of it, packed in between or not.
  ASSERT_TRUE(model.undo());
  const auto other = RefitJob::create(model, wanted);
  ASSERT_TRUE(other) << other.error().text();
  ASSERT_TRUE(model.pack());
  ASSERT_TRUE(model.undo());
  other->run();
  EXPECT_EQ(other->poll(), RefitJob::State::cancelled);
}

// ---- Memory.

TEST(TornAsset, an_untouched_model_takes_next_to_no_memory) {
  const auto asset = make_asset(test::make_tube(60, 60, 16));
  const std::uint64_t before = live_bytes();
  constexpr int kCount = 100;
  std::vector<TornModel> models;
  models.reserve(kCount);
  for (int i = 0; i < kCount; ++i) models.push_back(model_of(asset));
  for (const TornModel& model : models) {
    EXPECT_EQ(model.character().meshes[0].positions.data(),
              asset->character()->meshes[0].positions.data());
    EXPECT_GT(model.point_count(), 0u);
    EXPECT_LT(model.memory_bytes().own + model.memory_bytes().reserved, 1024u);
    EXPECT_EQ(model.memory_bytes().shared, asset->memory_bytes().shared);
  }
  EXPECT_LT(live_bytes() - before, std::uint64_t{1024} * kCount);

  // And so does one of which all operations were undone and then forgotten.
  models.clear();
  TornModel model = model_of(asset);
  Random random(1);
  ASSERT_TRUE(test::play(model, test::random_tear(model, random, false)));
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(model.pack());
  EXPECT_EQ(model.redo_count(), 1u);
  EXPECT_EQ(model.character(), model.source());
}

TEST(TornAsset, a_packed_model_takes_memory_for_what_was_torn) {
  // Whatever the size of the source.
  for (const std::uint32_t size : {20u, 60u, 160u}) {
    const auto asset = make_asset(test::make_tube(size, size, 8));
    ASSERT_TRUE(asset->prepare());
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(test::say("size ", size, ", seed ", seed));
      Random random(seed);
      auto model = std::make_unique<TornModel>(model_of(asset));
      for (std::uint64_t i = 0; i < 1 + 4 * seed; ++i) {
        const ModelPose pose = test::random_pose(model->source(), random, 0.3, 1.0);
        ASSERT_TRUE(model->tear(pose, test::random_stroke(model->source(), pose, random, 0.5, 4)));
      }
      const std::uint64_t vertices =
          model->character().meshes[0].vertex_count() - model->source().meshes[0].vertex_count();
      ASSERT_GT(vertices, 10u);
      ASSERT_TRUE(model->pack());
      const std::uint64_t operations = model->undo_count(),
                          of_poses =
                              operations * sizeof(Affine3d) * model->source().skeleton.bones.size();
      const TornMemory told = model->memory_bytes();
      const std::uint64_t before = live_bytes();
      model.reset();
      const std::uint64_t bytes = before - live_bytes();
      EXPECT_LT(bytes, 600 * vertices + of_poses + 2048 * operations + 8192)
          << vertices << " new vertices, " << operations << " operations";
      EXPECT_NEAR(static_cast<double>(told.own + told.reserved), static_cast<double>(bytes),
                  0.1 * static_cast<double>(bytes) + 1024);
    }
  }
}

TEST(TornAsset, idle_workspaces_are_used_again) {
  const auto asset = make_asset(test::make_tube(40, 40, 4));
  ASSERT_TRUE(asset->prepare(2));
  const std::size_t idle = asset->memory_bytes().reserved;
  Random random(1);
  for (int round = 0; round < 4; ++round) {
    std::vector<TornModel> models;
    for (int i = 0; i < 5; ++i) {
      models.push_back(model_of(asset));
      ASSERT_TRUE(test::play(models.back(), test::random_tear(models.back(), random, false)));
      if (round % 2 == 0) {
        ASSERT_TRUE(models.back().pack());
      }
    }
  }
  EXPECT_LT(asset->memory_bytes().reserved, 3 * idle / 2);
  EXPECT_GT(asset->memory_bytes().reserved, idle / 2);
}

TEST(TornAsset, a_prepared_workspace_spares_a_model_of_fixed_capacity_all_allocations) {
  const TornCapacity capacity{4000, 4000, 4};
  const auto asset = make_asset(test::make_tube(20, 24, 8));
  ASSERT_TRUE(asset->prepare(1, capacity));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = model_of(asset, capacity);
    const ModelPose pose = test::random_pose(model.source(), random, 0.4, 1.0);
    const Stroke stroke = test::random_stroke(model.source(), pose, random, 0.5, 3);
    if (seed == 0) {  // sizes what depends on the kind of the operation
      ASSERT_TRUE(model.tear(pose, stroke));
      continue;
    }
    const std::uint64_t before = test::allocation_count();
    const auto report = model.tear(pose, stroke);
    const std::uint64_t allocations = test::allocation_count() - before;
    ASSERT_TRUE(report) << report.error().text();
    if (report->pieces.empty()) {
      EXPECT_EQ(allocations, 0u);
    }
  }
}

TEST(TornAsset, where_memory_runs_out_nothing_changes) {
  const auto asset = make_asset(test::make_two_tubes(4, 6));
  const auto make = [&] {
    auto model = std::make_unique<TornModel>(model_of(asset));
    Random random(7);
    for (int i = 0; i < 3; ++i)
      EXPECT_TRUE(test::play(*model, test::random_operation(*model, random)));
    EXPECT_TRUE(model->undo());
    return model;
  };
  const test::ModelState state = state_of(*make());
  const auto check = [&](TornModel& model, const Status&) {
    EXPECT_EQ(difference(state, state_of(model)), "");
    ASSERT_TRUE(model.redo());
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
  };
  test::starve(
      make, [](TornModel& model) { return model.pack(); }, check);
  test::starve(
      [&] {
        auto model = make();
        EXPECT_TRUE(model->pack());
        return model;
      },
      [](TornModel& model) { return model.unpack(); }, check);
  const auto character = asset->character();
  test::starve([] { return std::make_unique<int>(); },
               [&](int&) { return test::status_of(TornAsset::create(character)); },
               [](int&, const Status&) {});
}

// ---- Threads.

TEST(TornAsset, models_of_one_asset_are_torn_in_several_threads) {
  const auto asset = make_asset(test::make_tube(10, 12, 4));
  constexpr std::uint64_t kThreads = 4;
  const auto run = [](TornModel& model, std::uint64_t seed, bool packs) {
    Random random(seed), of_packing(seed);
    for (int i = 0; i < 16; ++i) {
      act(model, random);
      if (packs && of_packing.index(2) == 0) {
        EXPECT_TRUE(model.pack());
      }
    }
    return model.digest();
  };
  std::vector<std::uint64_t> expected, digests(kThreads);
  for (std::uint64_t i = 0; i < kThreads; ++i) {
    TornModel alone = *TornModel::create(asset->character());
    expected.push_back(run(alone, i, false));
  }
  std::vector<std::thread> threads;
  for (std::uint64_t i = 0; i < kThreads; ++i)
    threads.emplace_back([&, i] {
      TornModel model = model_of(asset);
      digests[i] = run(model, i, true);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(digests, expected);
}

TEST(TornAsset, several_threads_read_a_packed_model) {
  const auto asset = make_asset(test::make_tube(10, 12, 4));
  TornModel model = model_of(asset);
  Random random(2);
  ASSERT_TRUE(test::play(model, test::random_tear(model, random, true)));
  const std::uint64_t digest = model.digest();
  ASSERT_TRUE(model.pack());
  std::vector<std::uint64_t> digests(4);
  std::vector<std::thread> threads;
  for (std::uint64_t& found : digests) threads.emplace_back([&] { found = model.digest(); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(digests, testing::Each(digest));
}

}  // namespace
}  // namespace sunder
