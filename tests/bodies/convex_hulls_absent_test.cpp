#include <sunder/bodies/convex_hulls.h>

#include <gtest/gtest.h>

namespace sunder {
namespace {

TEST(ConvexHulls, need_qhull) {
  EXPECT_FALSE(has_convex_hulls());
  const Vec3d point = Vec3d::Zero();
  EXPECT_EQ(convex_hull({&point, 1}).error().code(), StatusCode::unsupported_feature);
}

}  // namespace
}  // namespace sunder
