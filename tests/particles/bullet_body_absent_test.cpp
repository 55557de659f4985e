#include <sunder/particles/bullet_body.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

// In this build only its name is declared.
class btDynamicsWorld {};

namespace sunder {
namespace {

TEST(BulletBodyAbsent, create_returns_unsupported_feature) {
  EXPECT_FALSE(has_bullet_body());
  const auto sheet = std::make_shared<const Character>(test::make_sheet(4));
  const auto model = TornModel::create(sheet);
  ASSERT_TRUE(model);
  const auto set = ParticleSet::create(*model, *bind_pose(*sheet));
  ASSERT_TRUE(set);
  btDynamicsWorld world;
  const auto body = BulletBody::create(*set, world, *bind_pose(*sheet));
  ASSERT_FALSE(body);
  EXPECT_EQ(body.error().code(), StatusCode::unsupported_feature);
  EXPECT_NE(body.error().text().find("SUNDER_BULLET"), std::string_view::npos);
}

}  // namespace
}  // namespace sunder
