// Where memory runs out, an instance says so and goes on when there is memory again.

#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "support/machine/starve.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::starve;

const std::shared_ptr<const Character>& starved_tube() {
  static const auto character = std::make_shared<const Character>(test::make_tube(8, 10, 3));
  return character;
}

struct Case {
  Case() {
    test::Random random(3);
    for (int i = 0; i < 2; ++i) poses.push_back(test::random_pose(*starved_tube(), random, 0.3));
    stroke = test::random_stroke(*starved_tube(), poses[0], random, 0.3, 3);
  }
  Status tear() {
    return test::status_of(instance.tear(poses[0], stroke, {.width = 0.02, .wall_depth = 0.02}));
  }
  /// What is drawn of a frame that goes on from here.
  std::vector<Vec3f> drawn() {
    EXPECT_TRUE(instance.advance(poses[0], 0.02));
    EXPECT_TRUE(instance.draw());
    const auto positions = instance.mesh(0).positions;
    return {positions.begin(), positions.end()};
  }

  CharacterInstance instance = *CharacterInstance::create(starved_tube());
  std::vector<ModelPose> poses;
  Stroke stroke;
};

TEST(AllocationFailure, create_says_so) {
  const auto scene = [] { return std::make_unique<Case>(); };
  const auto nothing = [](Case&, const Status&) {};
  starve(
      scene, [](Case&) { return CharacterInstance::create(starved_tube()); }, nothing);
  CharacterAssetOptions soft;
  soft.soft.emplace();
  starve(
      scene, [&](Case&) { return CharacterInstance::create(starved_tube(), soft); }, nothing);
}

TEST(AllocationFailure, a_tear_changes_nothing) {
  Case fed;
  const std::vector<Vec3f> before = fed.drawn();
  ASSERT_TRUE(fed.tear());
  const std::vector<Vec3f> after = fed.drawn();
  const std::uint64_t digest = fed.instance.model()->digest();
  starve([] { return std::make_unique<Case>(); }, [](Case& of) { return of.tear(); },
         [&](Case& of, const Status& status) {
           if (!status) {
             ASSERT_EQ(of.drawn(), before);
             ASSERT_TRUE(of.tear());
           }
           ASSERT_EQ(of.instance.model()->digest(), digest);
           ASSERT_EQ(of.drawn(), after);
         });
}

TEST(AllocationFailure, a_frame_is_drawn_as_a_whole_later) {
  Case fed;
  (void)fed.drawn();
  ASSERT_TRUE(fed.tear());
  const std::vector<Vec3f> after = fed.drawn();
  starve(
      [] {
        auto scene = std::make_unique<Case>();
        (void)scene->drawn();
        EXPECT_TRUE(scene->tear());
        return scene;
      },
      [](Case& of) {
        const Status status = of.instance.advance(of.poses[1], 0.02);
        return status ? of.instance.draw() : status;
      },
      [&](Case& of, const Status& status) {
        if (!status) {  // what the failing frame wrote is listed with what the next one writes
          ASSERT_TRUE(of.instance.advance(of.poses[1], 0.02));
          ASSERT_TRUE(of.instance.draw());
          const PosedMesh drawn = of.instance.mesh(0);
          ASSERT_EQ(drawn.dirty_vertices.size(), 1u);
          ASSERT_EQ(drawn.dirty_vertices[0].count, drawn.positions.size());
          ASSERT_FALSE(drawn.triangle_writes.empty());
          ASSERT_FALSE(drawn.dirty_attributes.empty());
        }
        ASSERT_EQ(of.drawn(), after);
      });
}

}  // namespace
}  // namespace sunder
