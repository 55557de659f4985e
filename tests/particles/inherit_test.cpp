#include "particles/motion/inherit.h"

#include "particles/soft_scene.h"

namespace sunder {
namespace {
using particles::Motion;
using particles::RestMotion;

struct Torn {
  test::SoftScene scene{test::make_sheet(8), SoftMaterial(), 0.2};
  RestMotion rests;
  Motion motion;

  Torn() {
    EXPECT_TRUE(rests.begin(*scene.set, scene.pose));
    motion.resize(scene.count());
    for (Index p = 0; p < 3; ++p) {
      motion.displacements[p] = Vec3d(p + 1.0, 0, 0);
      motion.velocities[p] = Vec3d(0, p + 1.0, 0);
      motion.material_of[p] = p + 5;
    }
    rests.set_velocity(1, {0, 0, 8});
  }
};

TEST(inherit, a_new_particle_moves_like_its_parents) {
  Torn torn;
  // of a particle that undo removed
  torn.motion.forces[4] = torn.motion.displacements[4] = {9, 9, 9};
  particles::inherit({{2, 1, 0}, {0.5f, 0.25f, 0.25f}}, 4, torn.rests, torn.motion);
  EXPECT_EQ(torn.motion.displacements[4], Vec3d(2.25, 0, 0));
  EXPECT_EQ(torn.motion.velocities[4], Vec3d(0, 2.25, 0));
  EXPECT_EQ(torn.rests.velocity(4), Vec3d(0, 0, 2));
  EXPECT_EQ(torn.motion.material_of[4], 7u);
  EXPECT_EQ(torn.motion.forces[4], Vec3d::Zero());
  EXPECT_EQ(torn.motion.awake[4], 1);
}

TEST(inherit, one_without_parents_is_at_rest) {
  Torn torn;
  torn.motion.displacements[4] = torn.motion.velocities[4] = {9, 9, 9};
  particles::inherit({}, 4, torn.rests, torn.motion);
  EXPECT_EQ(torn.motion.displacements[4], Vec3d::Zero());
  EXPECT_EQ(torn.motion.velocities[4], Vec3d::Zero());
  EXPECT_EQ(torn.motion.material_of[4], 0u);
}

}  // namespace
}  // namespace sunder
