#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

std::vector<Affine3d> palette_of(const Character& character, const ModelPose& pose) {
  std::vector<Affine3d> palette(character.skins[0].bones.size());
  EXPECT_TRUE(compute_palette(character.skins[0], pose, palette));
  return palette;
}

std::vector<Affine3f> in_float(const std::vector<Affine3d>& palette) {
  std::vector<Affine3f> result;
  for (const Affine3d& matrix : palette) result.push_back(matrix.cast<float>());
  return result;
}

void add_tangents(Mesh& mesh) {
  for (const Vec3f& normal : mesh.normals) {
    const Eigen::Vector3f tangent = Eigen::Vector3f(normal).unitOrthogonal();
    mesh.tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(), -1.0f);
  }
}

TEST(Deform, agrees_with_the_double_precision_reference) {
  Character character = test::make_tube(12, 10, 5);
  add_tangents(character.meshes[0]);
  test::Random random(7);
  for (int i = 0; i < 50; ++i) {
    const ModelPose pose = test::random_pose(character, random, 1.5, 2.0);
    const auto palette = palette_of(character, pose);
    const Mesh& mesh = character.meshes[0];
    DeformedMesh deformed;
    ASSERT_TRUE(deform_mesh(mesh, in_float(palette), pose.morph_weights, deformed));
    const double diagonal = test::posed_diagonal(character, pose);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      ASSERT_LT((deformed.positions[v].cast<double>() -
                 deform_position_reference(mesh, v, palette, pose.morph_weights))
                    .norm(),
                2e-6 * diagonal);
      ASSERT_LT((deformed.normals[v].cast<double>() -
                 deform_normal_reference(mesh, v, palette, pose.morph_weights))
                    .norm(),
                2e-4);
      ASSERT_NEAR(deformed.tangents[v].head<3>().norm(), 1.0f, 1e-5f);
      ASSERT_EQ(deformed.tangents[v].w(), -1.0f);
    }
  }
}

TEST(Deform, a_rigid_motion_of_all_bones_moves_the_skin_rigidly) {
  const Character character = test::make_tube(6, 8, 3);
  ModelPose pose = *bind_pose(character);
  const Eigen::Affine3d motion = Eigen::Translation3d(1, -2, 3) *
                                 Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized());
  for (Affine3d& bone : pose.model_from_bone) bone = motion * bone;
  const Mesh& mesh = character.meshes[0];
  const auto palette = palette_of(character, pose);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_LT((deform_position_reference(mesh, v, palette, pose.morph_weights) -
               motion * Eigen::Vector3d(mesh.positions[v].cast<double>()))
                  .norm(),
              1e-6);
    EXPECT_LT((deform_normal_reference(mesh, v, palette, pose.morph_weights) -
               motion.linear() * mesh.normals[v].cast<double>())
                  .norm(),
              1e-6);
  }
}

TEST(Deform, normals_stay_across_the_surface_under_uneven_scale_and_outward_under_mirrors) {
  const Character character = test::make_sheet(1);
  ModelPose pose = *bind_pose(character);
  Mat3d linear;
  linear << -2, 0, 0, 0, 0.5, 0, 0.7, 0, 1;  // mirrored in x, sheared
  for (Affine3d& bone : pose.model_from_bone) bone.linear() = linear * bone.linear();
  const auto palette = palette_of(character, pose);
  const Vec3d normal = deform_normal_reference(character.meshes[0], 0, palette, {});
  EXPECT_NEAR(normal.dot(linear * Vec3d::UnitX()), 0, 1e-12);
  EXPECT_NEAR(normal.dot(linear * Vec3d::UnitY()), 0, 1e-12);
  EXPECT_GT(normal.dot(linear * Vec3d::UnitZ()), 0) << "what pointed out of the sheet still does";
}

TEST(Deform, a_collapsed_bone_gives_finite_results) {
  const Character character = test::make_sheet(2);
  ModelPose pose = *bind_pose(character);
  for (Affine3d& bone : pose.model_from_bone) bone.linear().setZero();
  DeformedMesh deformed;
  ASSERT_TRUE(
      deform_mesh(character.meshes[0], in_float(palette_of(character, pose)), {}, deformed));
  for (const Vec3f& normal : deformed.normals) EXPECT_EQ(normal, Vec3f(0, 0, 1));
}

TEST(Deform, morph_targets_come_before_bones) {
  const Character character = test::make_tube(4, 6, 2);
  ModelPose pose = *bind_pose(character);
  pose.morph_weights[0] = 1.0f;
  const Mesh& mesh = character.meshes[0];
  const auto palette = palette_of(character, pose);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f morphed = mesh.positions[v] + mesh.morph_targets[0].position_deltas[v];
    EXPECT_LT(
        (deform_position_reference(mesh, v, palette, pose.morph_weights) - morphed.cast<double>())
            .norm(),
        1e-6);
  }
}

TEST(Deform, refuses_palettes_and_weights_that_do_not_fit) {
  const Character character = test::make_tube(4, 6, 3);
  const ModelPose pose = *bind_pose(character);
  auto palette = palette_of(character, pose);
  DeformedMesh deformed;
  EXPECT_EQ(deform_mesh(character.meshes[0], in_float(palette), {}, deformed).code(),
            StatusCode::size_mismatch);
  palette.pop_back();
  EXPECT_EQ(
      deform_mesh(character.meshes[0], in_float(palette), pose.morph_weights, deformed).code(),
      StatusCode::size_mismatch);
  EXPECT_TRUE(deformed.positions.empty());
}

}  // namespace
}  // namespace sunder
