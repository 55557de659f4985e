// A blade that misses the curve by a little aims beside it; corners of links are seen between the
// places of a coarse surface.

#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/plan/clearance.h"
#include "pipeline/plan/target_path.h"
#include "plan/plan_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

std::shared_ptr<const Character> straight_tube() {
  return std::make_shared<const Character>(test::make_tube(40, 24, 3));
}

WoundTarget slant(const std::shared_ptr<const Character>& character) {
  std::vector<Vec3d> near;
  for (int i = 0; i <= 4; ++i) near.emplace_back(0.05 * i - 0.1, 0.5 + 0.05 * i, 0.3);
  WoundTarget target;
  target.places = test::nearest_places(character, *rest_pose(*character), near);
  return target;
}

TEST(AimBeside, moves_what_samples_aim_at_along_the_curve_and_across_it) {
  const auto character = straight_tube();
  const PlanTiming timing;
  auto path = plan::TargetPath::create(character, slant(character), *rest_pose(*character));
  ASSERT_TRUE(path) << path.error().text();
  const auto before = *plan::sample_target(*character, *path, timing, 200);
  plan::TargetPath aim = *path;
  aim.aim_beside(std::vector<Vec2d>(path->anchors().size(), Vec2d(0.004, 0.002)));
  aim.aim_beside(std::vector<Vec2d>(path->anchors().size(), Vec2d(-0.001, 0.002)));
  const auto after = *plan::sample_target(*character, aim, timing, 200);
  for (std::size_t i = 60; i < 140; ++i) {
    const Vec3d moved = after[i].place - before[i].place;
    const Vec3d along = (before[i + 3].place - before[i - 3].place).normalized();
    EXPECT_NEAR(moved.norm(), 0.005, 1e-9);  // 3 along, 4 across
    EXPECT_NEAR(moved.dot(along), 0.003, 1e-3);
    EXPECT_NEAR(moved.dot(before[i].normal), 0, 1e-9);
    EXPECT_EQ(after[i].normal, before[i].normal);
    EXPECT_EQ(after[i].depth, before[i].depth);
  }
  EXPECT_EQ(aim.length(), path->length());
}

TEST(AimBeside, corners_of_links_below_the_surface_are_found) {
  // Two large faces, of which places are 0.05 apart and more.
  const auto sheet = std::make_shared<const Character>(test::make_sheet(2));
  const ModelPose pose = *rest_pose(*sheet);
  const auto posed = test::posed_positions(*sheet, 0, pose);
  Vec3d middle = Vec3d::Zero();
  for (const Vec3d& place : posed) middle += place / static_cast<double>(posed.size());
  const Triangle& corners = sheet->meshes[0].triangles[0];
  const Vec3d normal = (posed[corners[1]] - posed[corners[0]])
                           .cross(posed[corners[2]] - posed[corners[0]])
                           .normalized();
  PlanTool tool = test::six_axis_arm(Vec3d::Zero());
  auto chain = plan::BladeChain::create(tool);
  ASSERT_TRUE(chain);
  const std::vector<plan::TargetSample> samples(2);
  test::Random random(4);
  int found = 0;
  constexpr int kBoxes = 25;
  for (int i = 0; i < kBoxes; ++i) {
    // A thin box of the base that stands on a corner, 1 mm below the surface.
    BoneCollider box{0, {Collider::Box{Vec3d(0.002, 0.2, 0.002)}}};
    const Vec3d beside = 0.2 * random.direction();
    box.collider.turn = Quatd(Eigen::Quaterniond::FromTwoVectors(
        Eigen::Vector3d::UnitY(), Eigen::Vector3d(normal + 0.3 * beside)));
    box.collider.place = Vec3d::Zero();
    double lowest = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Vec3d sign((corner & 1U) != 0 ? 1 : -1, (corner & 2U) != 0 ? 1 : -1,
                       (corner & 4U) != 0 ? 1 : -1);
      const Vec3d half = std::get<Collider::Box>(box.collider.shape).half_size;
      lowest = std::min(lowest, normal.dot(box.collider.turn * Vec3d(sign.cwiseProduct(half))));
    }
    box.collider.place =
        middle + (beside - beside.dot(normal) * normal) - (lowest + 0.001) * normal;
    tool.shapes = {box};
    const auto clearance = plan::Clearance::create(*sheet, tool, {}, samples);
    ASSERT_TRUE(clearance) << clearance.error().text();
    const auto rest = [&](double) { return chain->rest(); };
    const auto near = clearance->find(*chain, rest, 0.0005);
    if (!near.empty()) {
      ++found;
      EXPECT_LT(near[0].distance, 0.0005);
      EXPECT_NEAR((near[0].place - middle).dot(normal), 0, 1e-6);  // on the surface
    }
  }
  EXPECT_EQ(found, kBoxes);
}

}  // namespace
}  // namespace sunder
