#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder {
namespace {

TEST(Palette, model_matrices_multiply_down_the_tree) {
  const Character character = test::make_tube(2, 4, 3);
  Pose pose = *local_rest_pose(character);
  pose.parent_from_bone[0].rotation = Quatf(Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitZ()));
  pose.parent_from_bone[1].scale = {2, 1, 0.5};
  ModelPose model;
  ASSERT_TRUE(compute_model_pose(character.skeleton, pose, model));
  const Eigen::Affine3d root(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  const Eigen::Affine3d first =
      root * Eigen::Translation3d(0, 1, 0) * Eigen::Scaling(2.0, 1.0, 0.5);
  const Eigen::Affine3d second = first * Eigen::Translation3d(0, 1, 0);
  EXPECT_TRUE(model.model_from_bone[2].matrix().isApprox(second.matrix().topRows<3>(), 1e-6));
}

TEST(Palette, skin_in_bind_pose_reproduces_its_mesh) {
  Character character = test::make_tube(6, 8, 4);
  test::Random random(2);
  // Bind matrices that are unrelated to the rest pose.
  for (Affine3f& bind : character.skins[0].bone_from_bind)
    bind = Eigen::Affine3d(
               Eigen::AngleAxisd(random.uniform(-2, 2), Eigen::Vector3d(random.direction())) *
               Eigen::Translation3d(random.uniform(-1, 1), 1, 0) *
               Eigen::Scaling(random.uniform(0.5, 2)))
               .cast<float>();
  const ModelPose bind = *bind_pose(character);
  const auto positions = test::posed_positions(character, 0, bind);
  for (std::uint32_t v = 0; v < positions.size(); ++v)
    EXPECT_LT((positions[v] - character.meshes[0].positions[v].cast<double>()).norm(), 1e-5);
}

TEST(Palette, rigid_parts_stand_at_rest_in_bind_pose) {
  Character character = test::make_sheet(1);
  character.skeleton.bones[1].rest.translation = {5, 6, 7};
  character.skins[0] = {"rigid", {1}, {Affine3f::Identity()}};
  for (Influence& influence : character.meshes[0].weights.influences) influence = {0, 1.0f};
  EXPECT_EQ(bind_pose(character)->model_from_bone[1].translation(), Eigen::Vector3d(5, 6, 7));
}

TEST(Palette, sizes_are_checked) {
  const Character character = test::make_sheet(1);
  ModelPose model;
  EXPECT_EQ(compute_model_pose(character.skeleton, {}, model).code(), StatusCode::size_mismatch);
  std::vector<Affine3d> palette(1);
  EXPECT_EQ(compute_palette(character.skins[0], *bind_pose(character), palette).code(),
            StatusCode::size_mismatch);
  palette.resize(2);
  EXPECT_EQ(compute_palette(character.skins[0], model, palette).code(),
            StatusCode::index_out_of_range);
}

}  // namespace
}  // namespace sunder
