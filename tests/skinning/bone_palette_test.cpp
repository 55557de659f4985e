#include <sunder/skinning/bone_palette.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <limits>

#include <gtest/gtest.h>

#include "support/models/random_skin.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

TEST(BonePalette, knows_which_bones_changed_and_when) {
  test::Random random(1);
  auto matrices = test::in_float(test::random_palette(random, 5));
  BonePalette palette = *BonePalette::create(5, 2);
  EXPECT_EQ(palette.revision(), 0u);
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{0, 1}));
  const std::uint64_t first = palette.revision();
  EXPECT_GT(first, 0u);
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{0, 1}));
  EXPECT_EQ(palette.revision(), first) << "nothing changed";
  matrices[3].translation().x() += 1;
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{0, 1}));
  EXPECT_GT(palette.revision(), first);
  for (std::size_t slot = 0; slot < 5; ++slot)
    EXPECT_EQ(palette.revision_of(slot), slot == 3 ? palette.revision() : first);
  const std::uint64_t second = palette.revision();
  ASSERT_TRUE(palette.set(matrices, std::vector<float>{0.5f, 1}));
  EXPECT_GT(palette.revision(), second) << "a morph weight counts too";
  for (std::size_t slot = 0; slot < 5; ++slot) EXPECT_LE(palette.revision_of(slot), second);
}

TEST(BonePalette, a_pose_gives_the_matrices_of_compute_palette) {
  const Character character = test::make_tube(6, 8, 4);
  test::Random random(2);
  const ModelPose pose = test::random_pose(character, random, 1.0, 1.3);
  std::vector<Affine3f> matrices(4);
  ASSERT_TRUE(compute_palette(character.skins[0], pose, std::span(matrices)));
  BonePalette palette = *BonePalette::create(4, pose.morph_weights.size());
  ASSERT_TRUE(palette.set(character.skins[0], pose));
  const std::uint64_t revision = palette.revision();
  ASSERT_TRUE(palette.set(matrices, pose.morph_weights));
  EXPECT_EQ(palette.revision(), revision) << "the same bits";
  ASSERT_TRUE(palette.set(character.skins[0], pose));
  EXPECT_EQ(palette.revision(), revision);
  Affine3d frame = Affine3d::Identity();
  frame.translation().y() = 2;
  ASSERT_TRUE(palette.set(character.skins[0], pose, frame));
  EXPECT_GT(palette.revision(), revision);
}

TEST(BonePalette, a_character_that_only_moves_in_the_world_does_not_change) {
  // By whole metres and quarter turns, so that the products are exact.
  const Character character = test::make_tube(6, 8, 4);
  ModelPose pose = *bind_pose(character);
  BonePalette palette = *BonePalette::create(4, pose.morph_weights.size());
  ASSERT_TRUE(palette.set(character.skins[0], pose));
  const std::uint64_t revision = palette.revision();
  Affine3d travel = Affine3d::Identity();
  travel.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  travel.translation() = Vec3d(1024, 0, -2048);
  for (Affine3d& bone : pose.model_from_bone) bone = travel * bone;
  ASSERT_TRUE(palette.set(character.skins[0], pose, travel));
  EXPECT_EQ(palette.revision(), revision);
}

TEST(BonePalette, refuses_invalid_poses_and_changes_nothing) {
  const Character character = test::make_tube(6, 8, 4);
  ModelPose pose = *bind_pose(character);
  BonePalette palette = *BonePalette::create(4, pose.morph_weights.size());
  ASSERT_TRUE(palette.set(character.skins[0], pose));
  const std::uint64_t revision = palette.revision();
  const auto expect_fault = [&](const ModelPose& of, StatusCode code, std::uint32_t index) {
    const Status status = palette.set(character.skins[0], of);
    EXPECT_EQ(status.code(), code) << status.text();
    EXPECT_EQ(status.index(), index);
    EXPECT_EQ(palette.revision(), revision);
  };
  ModelPose bad = pose;
  bad.model_from_bone[2].translation().y() = std::numeric_limits<double>::infinity();
  expect_fault(bad, StatusCode::non_finite_value, 2);
  bad = pose;
  bad.model_from_bone[1].linear() *= 1e60;  // finite in double, not in float
  expect_fault(bad, StatusCode::non_finite_value, 1);
  bad = pose;
  bad.morph_weights[0] = std::numeric_limits<float>::quiet_NaN();
  expect_fault(bad, StatusCode::non_finite_value, 0);
  bad = pose;
  bad.morph_weights.clear();
  expect_fault(bad, StatusCode::size_mismatch, kNone);
  bad = pose;
  bad.model_from_bone.resize(2);
  expect_fault(bad, StatusCode::index_out_of_range, 2);
  EXPECT_EQ(palette.set(std::vector<Affine3f>(3, Affine3f::Identity()), pose.morph_weights).code(),
            StatusCode::size_mismatch);
  ASSERT_TRUE(palette.set(character.skins[0], pose));
  EXPECT_EQ(palette.revision(), revision);
}

TEST(NormalMatrix, is_the_linear_part_where_scale_is_even_and_across_the_surface_where_not) {
  test::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Affine3d even = test::random_palette(random, 1)[0];
    const double scale = random.uniform(0.01, 100) * (random.index(2) == 0 ? -1 : 1);
    EXPECT_EQ(compute_normal_matrix(scale * even.linear()), Mat3d(scale * even.linear()));

    Mat3d linear = even.linear();
    linear.col(0) *= random.uniform(1.1, 5);
    linear(0, 1) += random.uniform(-0.5, 0.5);
    if (std::abs(linear.determinant()) < 0.01) continue;
    const Mat3d normal = compute_normal_matrix(linear);
    const Vec3d a = random.direction(), b = random.direction(), n = a.cross(b).normalized();
    EXPECT_NEAR((normal * n).dot(linear * a), 0, 1e-12 * normal.norm() * linear.norm());
    EXPECT_NEAR((normal * n).dot(linear * b), 0, 1e-12 * normal.norm() * linear.norm());
    EXPECT_GT((normal * n).dot(linear * n), 0) << "outward stays outward";
    EXPECT_NEAR(normal.norm(), linear.norm(), 1e-12 * linear.norm());
  }
  Mat3d flat = Mat3d::Identity();
  flat(2, 2) = 0;
  EXPECT_GT(Vec3d(compute_normal_matrix(flat) * Vec3d(0.3, 0.2, 1)).normalized().z(), 0.9999)
      << "all normals of a flattened bone";
  Mat3d line = Mat3d::Zero();
  line(0, 0) = 1;
  EXPECT_EQ(compute_normal_matrix(line), Mat3d(Mat3d::Zero()));
}

}  // namespace
}  // namespace sunder
