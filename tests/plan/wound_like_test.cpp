// The wound of one character on another one.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/plan/posed_places.h"
#include "pipeline/plan/read_lips.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using Places = std::vector<Vec3d>;

/// A tube whose lengths are multiplied.
Character stretched_tube(std::uint32_t rings, std::uint32_t sides, const Vec3f& by) {
  Character tube = test::make_tube(rings, sides, 4);
  for (Vec3f& place : tube.meshes[0].positions) place = place.cwiseProduct(by);
  for (Bone& bone : tube.skeleton.bones)
    bone.rest.translation = bone.rest.translation.cwiseProduct(by);
  for (Affine3f& bind : tube.skins[0].bone_from_bind)
    bind.translation() = bind.translation().cwiseProduct(Eigen::Vector3f(by));
  tube.clips.clear();
  return tube;
}

/// Tears from one place before the tube to the other, at rest.
TornModel torn_tube(const Character& tube, const Places& before, double depth) {
  TornModel model = *TornModel::create(std::make_shared<const Character>(tube));
  TearOperation tear;
  for (std::size_t i = 0; i + 1 < before.size(); ++i)
    for (int k = 0; k <= 20; ++k) {
      const Vec3d at = before[i] + k / 20.0 * (before[i + 1] - before[i]);
      tear.stroke.push_back({at + Vec3d(0, 0, 0.5), at - Vec3d(0, 0, depth)});
    }
  EXPECT_TRUE(apply_operation(model, tear));
  return model;
}

Places places_of(const std::shared_ptr<const Character>& character, const WoundTarget& target) {
  Places places(target.places.size());
  EXPECT_TRUE(
      plan::PosedPlaces(*character, target.places).pose(*rest_pose(*character), places, {}));
  return places;
}

/// The largest distance of places from a line in x and y.
double farthest(const Places& places, const Places& line) {
  double most = 0;
  for (const Vec3d& place : places) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      for (int k = 0; k <= 200; ++k) {
        const Vec3d at = line[i] + k / 200.0 * (line[i + 1] - line[i]);
        least = std::min(least, std::hypot(place.x() - at.x(), place.y() - at.y()));
      }
    most = std::max(most, least);
  }
  return most;
}

const Places kLine = {{-0.06, 0.3, 0.15}, {0.05, 0.45, 0.15}, {0.02, 0.7, 0.15}};

TEST(WoundLike, on_the_same_character_is_where_it_was) {
  const Character tube = stretched_tube(40, 24, Vec3f(1, 1, 1));
  const TornModel torn = torn_tube(tube, kLine, 0.05);
  const auto same = std::make_shared<const Character>(tube);
  const auto target = wound_like(torn.character(), same);
  ASSERT_TRUE(target) << target.error().text();
  EXPECT_FALSE(target->is_closed);
  EXPECT_GE(target->places.size(), 30u);
  const Places places = places_of(same, *target);
  EXPECT_LT(farthest(places, kLine), 1e-3);
  EXPECT_LT(std::min((places.front() - places.back()).y(), (places.back() - places.front()).y()),
            -0.3);  // from end to end
}

TEST(WoundLike, is_scaled_by_the_limb) {
  const TornModel torn = torn_tube(stretched_tube(40, 24, Vec3f(1, 1, 1)), kLine, 0.05);
  // Twice as large, of other triangles: all of it twice as large.
  const auto large = std::make_shared<const Character>(stretched_tube(55, 30, Vec3f(2, 2, 2)));
  const auto target = wound_like(torn.character(), large);
  ASSERT_TRUE(target) << target.error().text();
  Places line = kLine;
  for (Vec3d& place : line) place *= 2;
  EXPECT_LT(farthest(places_of(large, *target), line), 0.02);
  // Longer, but as thick: at the same shares of its limbs, on the same side.
  const auto longer = std::make_shared<const Character>(stretched_tube(60, 24, Vec3f(1, 1.5, 1)));
  const auto along = wound_like(torn.character(), longer);
  ASSERT_TRUE(along) << along.error().text();
  const Places places = places_of(longer, *along);
  double low = 1e9, high = -1e9;
  for (const Vec3d& place : places) {
    low = std::min(low, place.y());
    high = std::max(high, place.y());
    EXPECT_GT(place.z(), 0);
  }
  EXPECT_NEAR(low, 1.5 * 0.3, 0.02);
  EXPECT_NEAR(high, 1.5 * 0.7, 0.02);
}

TEST(WoundLike, finds_bones_whose_names_are_similar) {
  const TornModel torn = torn_tube(stretched_tube(40, 24, Vec3f(1, 1, 1)), kLine, 0.05);
  Character named = stretched_tube(40, 24, Vec3f(1, 1, 1));
  for (Bone& bone : named.skeleton.bones) {
    std::string name = "rig:";
    for (const char letter : bone.name)
      name += letter == '_' || letter == '.' ? '-' : static_cast<char>(std::toupper(letter));
    bone.name = name;
  }
  const auto similar = std::make_shared<const Character>(named);
  const auto target = wound_like(torn.character(), similar);
  ASSERT_TRUE(target) << target.error().text();
  EXPECT_LT(farthest(places_of(similar, *target), kLine), 1e-3);
  for (Bone& bone : named.skeleton.bones)
    bone.name = "other" + std::to_string(&bone - named.skeleton.bones.data());
  const auto none = wound_like(torn.character(), std::make_shared<const Character>(named));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code(), StatusCode::not_found);
  EXPECT_THAT(std::string(none.error().text()), testing::HasSubstr("no bone"));
}

TEST(WoundLike, needs_lips) {
  const Character tube = stretched_tube(20, 12, Vec3f(1, 1, 1));
  const auto whole = wound_like(tube, std::make_shared<const Character>(tube));
  ASSERT_FALSE(whole);
  EXPECT_EQ(whole.error().code(), StatusCode::not_found);
  EXPECT_FALSE(wound_like(tube, nullptr));
  EXPECT_FALSE(plan::read_lips(test::make_sheet(5)));  // has borders
}

TEST(WoundLike, of_a_closed_tear_is_closed) {
  const Character tube = stretched_tube(40, 24, Vec3f(1, 1, 1));
  Places ring;
  for (int i = 0; i <= 24; ++i)
    ring.emplace_back(0.06 * std::cos(i * 0.2617993878), 0.5 + 0.06 * std::sin(i * 0.2617993878),
                      0.15);
  const TornModel torn = torn_tube(tube, ring, 0.05);
  const auto same = std::make_shared<const Character>(tube);
  const auto target = wound_like(torn.character(), same);
  ASSERT_TRUE(target) << target.error().text();
  EXPECT_TRUE(target->is_closed);
  EXPECT_LT(farthest(places_of(same, *target), ring), 1e-3);
}

}  // namespace
}  // namespace sunder
