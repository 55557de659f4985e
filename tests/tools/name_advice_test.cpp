#include "tools/model/name_advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sunder::tools {
namespace {

TEST(NameAdvice, lists_what_there_is_if_nothing_is_near) {
  const std::vector<std::string> clips = {"Idle", "Walk"};
  EXPECT_EQ(name_advice("Wakl", "clips", clips), "; did you mean 'Walk'?");
  EXPECT_EQ(name_advice("Swim", "clips", clips), "; its clips: 'Idle', 'Walk'");
  EXPECT_EQ(name_advice("Swim", "clips", {}), "; the model has no clips");
  const std::vector<std::string> many(30, "Bone");
  EXPECT_THAT(name_advice("Swim", "bones", many), testing::EndsWith("'Bone' and 20 more"));
}

}  // namespace
}  // namespace sunder::tools
