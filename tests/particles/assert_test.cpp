// Documented preconditions stop debug builds; elsewhere nothing is promised, so nothing is tested.

#include <gtest/gtest.h>

#include "particles/soft_scene.h"

namespace sunder {
namespace {

#if !defined(NDEBUG)

TEST(AssertDeathTest, particles_and_points_that_do_not_exist) {
  test::SoftScene scene(test::make_sheet(4), {}, 0.5);
  const std::uint32_t particle = scene.set->particle_count(), point = scene.set->point_count();
  EXPECT_DEATH((void)scene.set->seed(particle), "particle_count");
  EXPECT_DEATH((void)scene.set->memberships(point), "point_count");
  EXPECT_DEATH((void)scene.body->displacement(particle), "particle_count");
  EXPECT_DEATH((void)scene.body->point_displacement(point), "point_count");
}

#endif

}  // namespace
}  // namespace sunder
