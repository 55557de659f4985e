// What a mask knows beside distances, and masks of some operations.

#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/wound_mask.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/atlas_tube.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/wound_distances.h"

namespace sunder {
namespace {

using test::BruteForceLip;
using test::LipHistory;
using test::make_model;
using test::Random;

constexpr std::uint32_t kTexels = 96;

WoundMaskOptions channel_options(double reach) {
  WoundMaskOptions options;
  options.width = options.height = kTexels;
  options.reach = reach;
  return options;
}

WoundMask mask_of(const TornModel& model, const WoundMaskOptions& options) {
  auto mask = WoundMask::create(model, 0, options);
  EXPECT_TRUE(mask) << mask.error().text();
  return std::move(*mask);
}

std::vector<float> channel_of(const TornModel& model, const WoundMask& mask, WoundChannel wanted) {
  auto values = mask.channel(model, wanted);
  EXPECT_TRUE(values) << values.error().text();
  return std::move(*values);
}

/// A sheet with some crossing wounds, and which operation made each lip.
struct WoundedSheet {
  explicit WoundedSheet(int seed)
      : random(static_cast<std::uint64_t>(seed)),
        model(make_model(test::make_sheet(4 + random.index(6)))),
        history(model) {
    for (int i = 0; i < 5; ++i) {
      if (i == 3 && seed % 3 == 0) {
        EXPECT_TRUE(model.undo());
      } else {
        TearOptions options;
        if (i == 1) options.width = random.uniform(0.01, 0.04);
        EXPECT_TRUE(model.tear(*bind_pose(model.source()), test::turning_stroke(random), options));
      }
      history.record(model);
    }
    for (const BruteForceLip& lip : test::brute_force_lips(model, 0))
      lips.emplace_back(lip, history.operation_of(lip));
  }

  /// The distance of a texel from the lips of one operation; the sheet is flat and convex.
  [[nodiscard]] double distance(std::uint32_t operation, std::uint32_t texel) const {
    const Vec3d place((texel % kTexels + 0.5) / kTexels, (texel / kTexels + 0.5) / kTexels, 0);
    double least = 10;
    for (const auto& [lip, made_by] : lips) {
      if (made_by != operation) continue;
      const Vec3d along = lip[1] - lip[0];
      const double part = std::clamp((place - lip[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (place - lip[0] - part * along).norm());
    }
    return least;
  }

  Random random;
  TornModel model;
  LipHistory history;
  std::vector<std::pair<BruteForceLip, std::uint32_t>> lips;  ///< With the operation that made it.
};

TEST(WoundChannels, ages_are_those_of_the_nearest_lip_by_brute_force) {
  constexpr double kReach = 0.2;
  std::vector<std::size_t> texels_of_age(8);
  for (int seed = 0; seed < test::stressed(6, 60); ++seed) {
    SCOPED_TRACE(seed);
    const WoundedSheet sheet(seed);
    const std::uint32_t count = sheet.model.undo_count();
    const WoundMask mask = mask_of(sheet.model, channel_options(kReach));
    const std::vector<float> ages = channel_of(sheet.model, mask, WoundChannel::age);
    for (std::uint32_t i = 0; i < ages.size(); i += 7) {
      double least = kReach;
      for (std::uint32_t k = 0; k < count; ++k) least = std::min(least, sheet.distance(k, i));
      if (ages[i] < 0) {
        ASSERT_GT(least, kReach - 1e-5);
        continue;
      }
      const auto age = static_cast<std::uint32_t>(ages[i]);
      ASSERT_LT(age, count);
      ASSERT_LT(sheet.distance(count - 1 - age, i), least + 1e-5) << "texel " << i;
      ++texels_of_age[age];
    }
  }
  for (std::size_t age = 0; age < 4; ++age) EXPECT_GT(texels_of_age[age], 50U) << age;
}

TEST(WoundChannels, a_mask_of_some_operations_agrees_with_brute_force) {
  constexpr double kReach = 0.2;
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(test::stressed(6, 60)); ++seed) {
    SCOPED_TRACE(seed);
    const WoundedSheet sheet(static_cast<int>(seed));
    WoundMaskOptions options = channel_options(kReach);
    options.first_operation = seed % 4;
    options.operation_count = 1 + seed % 2;
    const WoundMask mask = mask_of(sheet.model, options);
    for (std::uint32_t i = 0; i < kTexels * kTexels; i += 7) {
      double least = kReach;
      for (std::uint32_t k = 0; k < options.operation_count; ++k)
        least = std::min(least, sheet.distance(options.first_operation + k, i));
      ASSERT_NEAR(std::abs(mask.distances()[i]), least, 1e-5) << i;
    }
  }
}

TEST(WoundChannels, only_the_skin_that_wanted_operations_removed_is_negative) {
  const Character sheet = test::make_sheet(8);
  TornModel model = make_model(sheet);
  for (const double y : {0.25, 0.75})
    ASSERT_TRUE(
        model.tear(*bind_pose(sheet), Stroke{test::down_at(0.2, y), test::down_at(0.8, y)}, {0.1}));
  WoundMaskOptions options = channel_options(0.04);
  options.operation_count = 1;
  for (const std::uint32_t wanted : {0U, 1U, 2U}) {
    options.first_operation = wanted;
    const WoundMask mask = mask_of(model, options);
    for (const std::uint32_t gap : {0U, 1U}) {
      const std::size_t middle = (24 + 48 * gap) * kTexels + 48;
      EXPECT_EQ(mask.distances()[middle], gap == wanted ? -0.04f : 0.04f);
      EXPECT_EQ(mask.distances()[middle - 4 * kTexels] < 0.01f, gap == wanted);
    }
  }
}

TEST(WoundChannels, a_mask_of_some_operations_follows_them) {
  for (int seed = 0; seed < test::stressed(6, 60) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    TornModel model = make_model(test::random_character(random));
    WoundMaskOptions options = channel_options(0.15);
    options.first_operation = random.index(3);
    options.operation_count = 1 + random.index(3);
    WoundMask mask = mask_of(model, options);
    for (int step = 0; step < 12; ++step) {
      SCOPED_TRACE(step);
      ChangeRecord change;
      const std::size_t choice = random.index(5);
      if (choice == 0 && model.undo_count() > 0)
        ASSERT_TRUE(model.undo(&change));
      else if (choice == 1 && model.redo_count() > 0)
        ASSERT_TRUE(model.redo(&change));
      else if (choice == 2 && model.undo_count() > 0)
        ASSERT_TRUE(test::play(model, test::random_weld(model, random), &change));
      else if (!test::play(model, test::random_operation(model, random), &change))
        continue;
      ASSERT_TRUE(mask.update(model, change));
      const WoundMask whole = mask_of(model, options);
      ASSERT_TRUE(std::ranges::equal(mask.distances(), whole.distances()));
      for (const WoundChannel wanted : {WoundChannel::age, WoundChannel::depth})
        ASSERT_EQ(channel_of(model, mask, wanted), channel_of(model, whole, wanted));
    }
  }
}

TEST(WoundChannels, a_stroke_under_way_is_the_newest_operation) {
  const Character sheet = test::make_sheet(8);
  TornModel model = make_model(sheet);
  const ModelPose pose = *bind_pose(sheet);
  ASSERT_TRUE(model.tear(pose, Stroke{test::down_at(0.5, 0.1), test::down_at(0.5, 0.9)}));
  auto stroke = TearStroke::create(model, pose, test::down_at(0.2, 0.5));
  ASSERT_TRUE(stroke);
  for (const double x : {0.4, 0.6, 0.8}) ASSERT_TRUE(stroke->extend(pose, test::down_at(x, 0.5)));
  const auto ages = [&] {
    const WoundMask mask = mask_of(model, channel_options(0.05));
    const std::vector<float> of = channel_of(model, mask, WoundChannel::age);
    return std::array{of[48 * kTexels + 67], of[80 * kTexels + 48], of[10 * kTexels + 10]};
  };
  const std::array<float, 3> wanted = {0, 1, -1};
  EXPECT_EQ(ages(), wanted);
  ASSERT_TRUE(stroke->end());
  EXPECT_EQ(ages(), wanted);
}

TEST(WoundChannels, depth_is_that_of_the_wall_below) {
  const Character sheet = test::make_sheet(16);
  TornModel model = make_model(sheet);
  TearOptions options;
  options.wall_depth = 0.06;
  ASSERT_TRUE(model.tear(*bind_pose(sheet),
                         Stroke{test::down_at(0.2, 0.3), test::down_at(0.8, 0.3)}, options));
  ASSERT_TRUE(
      model.tear(*bind_pose(sheet), Stroke{test::down_at(0.2, 0.7), test::down_at(0.8, 0.7)}));
  const WoundMask mask = mask_of(model, channel_options(0.1));
  const std::vector<float> depths = channel_of(model, mask, WoundChannel::depth);
  const Mesh& torn = model.character().meshes[0];
  // By the vertices below: the farthest one from the stroke in the same place along it.
  const auto depth_beside = [&](double x) {
    double most = 0;
    for (const Vec3f& at : torn.positions)
      if (at.z() != 0 && std::abs(at.x() - x) < 0.04)
        most = std::max(most, std::hypot(at.y() - 0.3, at.z()));
    return most;
  };
  std::size_t count = 0;
  for (std::size_t column = 0; column < kTexels; ++column) {
    const double x = (static_cast<double>(column) + 0.5) / kTexels;
    const float depth = depths[27 * kTexels + column];
    if (x > 0.3 && x < 0.7) {
      ++count;
      EXPECT_NEAR(depth, depth_beside(x), 0.005) << x;
    }
    EXPECT_EQ(depths[68 * kTexels + column], 0) << "no walls";
  }
  EXPECT_GT(count, 20U);
  EXPECT_GT(depths[27 * kTexels + 48], 0.055);
  EXPECT_LT(depths[27 * kTexels + 20], 0.5f * depths[27 * kTexels + 48]) << "shallow at the tip";
  EXPECT_EQ(depths[5 * kTexels + 48], 0) << "beyond reach";
}

TEST(WoundChannels, stretch_is_the_largest_of_all_directions) {
  Random random(7);
  const Character tube = test::make_atlas_tube(10, 10);
  TornModel model = make_model(tube);
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(test::play(model, test::random_tear(model, random, i == 1)));
  const WoundMask mask = mask_of(model, channel_options(0.1));
  Mat3d strain;
  for (int i = 0; i < 9; ++i) strain(i / 3, i % 3) = random.uniform(-1, 1) + (i % 4 == 0 ? 1 : 0);
  std::vector<Vec3f> posed;
  for (const Vec3f& at : model.character().meshes[0].positions)
    posed.push_back((strain * at.cast<double>()).cast<float>());
  const auto stretches = mask.stretches(model, posed);
  ASSERT_TRUE(stretches) << stretches.error().text();
  const Mesh& mesh = tube.meshes[0];
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < stretches->size(); ++i) {
    const float distance = mask.distances()[i];
    const auto place = mask.place_of(i % kTexels, i / kTexels);
    if (!place || distance == 0.1f || distance < 0) {
      EXPECT_EQ((*stretches)[i], 1);
      continue;
    }
    const Triangle& t = mesh.triangles[place->triangle];
    const Vec3d a = (mesh.positions[t[1]] - mesh.positions[t[0]]).cast<double>().normalized(),
                c = (mesh.positions[t[2]] - mesh.positions[t[0]]).cast<double>(),
                b = (c - c.dot(a) * a).normalized();
    double most = 0;
    for (int k = 0; k < 360; ++k) {
      const double angle = k * std::numbers::pi / 360;
      most = std::max(most, (strain * (std::cos(angle) * a + std::sin(angle) * b)).norm());
    }
    ++count;
    ASSERT_NEAR((*stretches)[i], most, 1e-3 * most) << i;
  }
  EXPECT_GT(count, 100U);
}

TEST(WoundChannels, refuse_what_they_cannot_tell) {
  const Character sheet = test::make_sheet(4);
  TornModel model = make_model(sheet);
  const WoundMask mask = mask_of(model, channel_options(0.1));
  ASSERT_TRUE(
      model.tear(*bind_pose(sheet), Stroke{test::down_at(0.2, 0.4), test::down_at(0.8, 0.4)}));
  const auto code_of = [](const auto& result) {
    return result ? StatusCode::ok : result.error().code();
  };
  EXPECT_EQ(code_of(mask.channel(model, WoundChannel::age)), StatusCode::invalid_argument)
      << "it did not follow the tear";
  EXPECT_EQ(code_of(mask.channel(make_model(test::make_sheet(5)), WoundChannel::depth)),
            StatusCode::invalid_argument);
  const WoundMask now = mask_of(model, channel_options(0.1));
  EXPECT_EQ(code_of(now.channel(model, static_cast<WoundChannel>(7))),
            StatusCode::invalid_argument);
  std::vector<Vec3f> posed = model.character().meshes[0].positions;
  EXPECT_EQ(code_of(now.stretches(model, posed)), StatusCode::ok);
  posed[3].x() = std::nanf("");
  EXPECT_EQ(code_of(now.stretches(model, posed)), StatusCode::non_finite_value);
  posed.pop_back();
  EXPECT_EQ(code_of(now.stretches(model, posed)), StatusCode::size_mismatch);
}

}  // namespace
}  // namespace sunder
