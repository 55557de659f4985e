#include "particles/motion/pose_tension.h"

#include <sunder/particles/soft_body.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "particles/soft_scene.h"
#include "support/machine/random.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

using test::SlitSheet;
using test::SoftScene;

/// Vectors in a random plane, turned and stretched.
struct StretchedPlane {
  Eigen::Matrix<double, 3, 2> plane;
  Eigen::Matrix2d stretch;
  Mat3d moments = Mat3d::Zero(), moved = Mat3d::Zero();

  StretchedPlane(test::Random& random, int count) {
    const Eigen::Quaterniond turn(random.uniform(-1, 1), random.uniform(-1, 1),
                                  random.uniform(-1, 1), random.uniform(-1, 1));
    plane = turn.normalized().toRotationMatrix().leftCols<2>();
    const double angle = random.uniform(0, std::numbers::pi);
    const Eigen::Rotation2Dd axes(angle);
    stretch = axes.toRotationMatrix() *
              Eigen::Vector2d(random.uniform(0.1, 3), random.uniform(0.1, 3)).asDiagonal() *
              axes.toRotationMatrix().transpose();
    const Mat3d moved_turn =
        Eigen::AngleAxisd(random.uniform(0, 3), Vec3d(1, 2, -1).normalized()).toRotationMatrix();
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d in_plane(random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3d before = plane * in_plane, now = moved_turn * (plane * (stretch * in_plane));
      const double weight = random.uniform(0.1, 2);
      moments += weight * before * before.transpose();
      moved += weight * now * before.transpose();
    }
  }
};

TEST(pose_tension, finds_the_stretch_of_a_plane) {
  test::Random random(5);
  for (int i = 0; i < 300; ++i) {
    const StretchedPlane of(random, 3 + i % 5);
    const Mat3d wanted =
        of.plane * (of.stretch - Eigen::Matrix2d::Identity()) * of.plane.transpose();
    EXPECT_LT((particles::strain_of(of.moments, of.moved) - wanted).norm(), 1e-6) << i;
  }
}

TEST(pose_tension, vectors_in_a_row_have_no_stretch) {
  test::Random random(6);
  for (int i = 0; i < 50; ++i) {
    const StretchedPlane of(random, 1);
    EXPECT_EQ(particles::strain_of(of.moments, of.moved), Mat3d(Mat3d::Zero()));
  }
  EXPECT_EQ(particles::strain_of(Mat3d::Zero(), Mat3d::Zero()), Mat3d(Mat3d::Zero()));
}

/// The pose with all points stretched in x and y, and turned.
ModelPose stretched(const ModelPose& pose, const Vec3d& by, double angle) {
  Affine3d affine = test::turn_by(angle, Vec3d(1, -2, 0.5).normalized());
  affine.linear() = affine.linear() * by.asDiagonal();
  return test::moved(pose, affine);
}

/// The widest gap of a slit along x in a stretched sheet, in balance.
double gap_in(const ModelPose& pose, SlitSheet& sheet, const Tension& tension) {
  EXPECT_TRUE(sheet.body->set_tension(tension));
  for (int i = 0; i < 400 && (i < 2 || sheet.body->awake_count() > 0); ++i)
    EXPECT_TRUE(sheet.body->step(*sheet.model, pose, 0.1));
  return test::gap_of(sheet).widest();
}

TEST(pose_tension, a_stretched_sheet_pulls_by_stiffness_times_strain) {
  const SoftMaterial material;
  for (const auto& [tension, strain] :
       {std::pair(0.0, 0.3), std::pair(1.2, 0.2), std::pair(1.2, -0.1), std::pair(0.5, 1.0)}) {
    SlitSheet still(60, 0.2, 0.1, material), moved(60, 0.2, 0.1, material);
    const double wanted =
        gap_in(still.pose, still, {tension + strain * material.membrane_stiffness, {}, false});
    const double found =
        gap_in(stretched(moved.pose, Vec3d(0.7, 1 + strain, 1), 1.1), moved, {tension, {}, true});
    EXPECT_GT(wanted, 0.01);
    EXPECT_NEAR(found / wanted, 1, 2e-3) << tension << " " << strain;
  }
}

TEST(pose_tension, compressed_tissue_stays_closed) {
  SlitSheet sheet(60, 0.2, 0.1, {});
  // Up to the shear by the rounding of positions.
  EXPECT_LT(gap_in(stretched(sheet.pose, Vec3d(1.5, 0.6, 1), 0.4), sheet, {1.0, {}, true}), 1e-6);
}

TEST(pose_tension, only_counts_where_it_is_wanted) {
  SlitSheet sheet(60, 0.2, 0.1, {}), other(60, 0.2, 0.1, {});
  const double still = gap_in(sheet.pose, sheet, {1.2, {}, false});
  EXPECT_EQ(gap_in(other.pose, other, {1.2, {}, true}), still);  // the decomposition's pose
  EXPECT_NEAR(gap_in(stretched(other.pose, Vec3d(1, 1.5, 1), 0), other, {1.2, {}, false}), still,
              1e-4 * still);
}

TEST(pose_tension, follows_the_pose_of_a_sleeping_body) {
  SlitSheet sheet(60, 0.2, 0.1, {});
  EXPECT_EQ(gap_in(sheet.pose, sheet, {0.0, {}, true}), 0);
  EXPECT_EQ(sheet.body->awake_count(), 0u);
  const ModelPose pose = stretched(sheet.pose, Vec3d(1, 1.4, 1), 0);
  const auto run = [&](const ModelPose& to) {
    for (int i = 0; i < 400 && (i < 2 || sheet.body->awake_count() > 0); ++i)
      ASSERT_TRUE(sheet.body->step(*sheet.model, to, 0.1));
  };
  run(pose);
  EXPECT_GT(test::gap_of(sheet).widest(), 0.05);
  EXPECT_FALSE(sheet.body->needs_step());
  run(sheet.pose);
  EXPECT_LT(test::gap_of(sheet).widest(), 1e-4);
}

TEST(pose_tension, a_stiffer_material_pulls_more) {
  // The gap of a slit under the tension S e is that of any S if the foundation grows with S.
  SoftMaterial soft, stiff;
  stiff.membrane_stiffness = 4 * soft.membrane_stiffness;
  stiff.return_frequency = 2 * soft.return_frequency;
  SlitSheet sheet(60, 0.2, 0.1, soft);
  const ModelPose pose = stretched(sheet.pose, Vec3d(1, 1.3, 1), 0);
  const double before = gap_in(pose, sheet, {0.0, {}, true});
  ASSERT_TRUE(sheet.body->change_material(0, stiff));
  EXPECT_NEAR(gap_in(pose, sheet, {0.0, {}, true}) / before, 1, 1e-3);
}

TEST(pose_tension, goes_on_after_restore) {
  SlitSheet sheet(40, 0.2, 0.1, {});
  ASSERT_TRUE(sheet.body->set_tension({0.4, {}, true}));
  const auto pose_at = [&](int i) {
    return stretched(sheet.pose, Vec3d(1, 1 + 0.03 * i, 1), 0.05 * i);
  };
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(sheet.body->step(*sheet.model, pose_at(i), 1.0 / 60));
  const auto saved = sheet.body->save();
  ASSERT_TRUE(saved);
  auto copy = SoftBody::create(*sheet.set, sheet.pose, sheet.body->materials());
  ASSERT_TRUE(copy);
  ASSERT_TRUE(copy->restore(*saved));
  for (int i = 7; i < 14; ++i)
    for (SoftBody* body : {&*sheet.body, &*copy})
      ASSERT_TRUE(body->step(*sheet.model, pose_at(i), 1.0 / 60));
  for (std::uint32_t p = 0; p < sheet.set->particle_count(); ++p)
    EXPECT_EQ(copy->displacement(p), sheet.body->displacement(p));
  EXPECT_GT(test::gap_of(sheet).widest(), 0.01);
}

/// The gap of a tear around a bent tube, on the side that the bend stretches or compresses.
double gap_of_bend(double angle, bool is_outside) {
  Character tube = test::make_tube(160, 128, 2);
  SoftScene scene(std::move(tube), SoftMaterial{}, 0.05);
  const Skeleton& skeleton = scene.character->skeleton;
  double bottom = 1e9, top = -1e9, radius = 0;
  for (const Vec3f& at : scene.character->meshes[0].positions) {
    bottom = std::min(bottom, double{at.y()});
    top = std::max(top, double{at.y()});
    radius = std::max(radius, std::hypot(double{at.x()}, double{at.z()}));
  }
  EXPECT_EQ(skeleton.bones.size(), 2u);
  // The upper bone turns about z in the middle, so the side of +x is compressed if it bends there.
  const double middle = 0.5 * (bottom + top) + 0.013;
  const double side = is_outside ? -1 : 1;
  const auto blade = [&](double z) {
    return Blade{{side * 2 * radius, middle, z}, {side * 0.3 * radius, middle, z}};
  };
  const Stroke stroke = {blade(-0.6 * radius), blade(0.6 * radius)};
  ChangeRecord change;
  EXPECT_TRUE(scene.model->tear(scene.pose, stroke, {}, &change));
  EXPECT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  const Vec3d pivot(0, middle, 0);
  const ModelPose straight = scene.pose;
  const Affine3d bend = Eigen::Translation3d(pivot) *
                        Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()) *
                        Eigen::Translation3d(Vec3d(-pivot));
  scene.pose.model_from_bone[1] = bend * straight.model_from_bone[1];
  EXPECT_TRUE(scene.body->set_tension({0.2, {}, true}));
  for (int i = 0; i < 400 && (i < 2 || scene.body->awake_count() > 0); ++i) scene.step(0.1);
  double widest = 0;
  for (const MeshChange& of : change.meshes) EXPECT_EQ(of.mesh, 0u);
  for (const LipPair& pair : change.lips)
    widest = std::max(widest, (scene.body->point_displacement(pair.left) -
                               scene.body->point_displacement(pair.right))
                                  .norm());
  return widest / radius;
}

TEST(pose_tension, a_wound_gapes_wider_in_a_pose_that_pulls_it_open) {
  const double straight = gap_of_bend(0, true);
  EXPECT_NEAR(gap_of_bend(0, false), straight, 0.05 * straight);
  double before = straight;
  for (const double angle : {0.3, 0.6, 0.9}) {
    const double wide = gap_of_bend(angle, true);
    EXPECT_GT(wide, 1.1 * before) << angle;
    before = wide;
  }
  EXPECT_LT(gap_of_bend(0.9, false), 0.1 * straight);
}

}  // namespace
}  // namespace sunder
