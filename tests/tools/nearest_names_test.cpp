#include "core/internal/nearest_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/model/name_advice.h"

namespace sunder::tools {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NearestNames, mistyped_names_are_found_nearest_first) {
  const std::vector<std::string> clips = {"Idle", "Walk", "Walking", "Run", "Jump_Land"};
  EXPECT_THAT(nearest_names("walk", clips), ElementsAre("Walk", "Walking"));
  EXPECT_THAT(nearest_names("Wlak", clips), ElementsAre("Walk"));
  EXPECT_THAT(nearest_names("Walkin", clips), ElementsAre("Walking", "Walk"));
  EXPECT_THAT(nearest_names("land", clips), ElementsAre("Jump_Land"));
  EXPECT_THAT(nearest_names("Swim", clips), IsEmpty());
  EXPECT_THAT(nearest_names("Walk", {}), IsEmpty());
}

TEST(NearestNames, at_most_three_are_proposed) {
  const std::vector<std::string> bones = {"Arm.L", "Arm.R", "Arm.1", "Arm.2", "Arm.3"};
  EXPECT_THAT(nearest_names("Arm", bones), ElementsAre("Arm.L", "Arm.R", "Arm.1"));
}

TEST(NearestNames, the_advice_lists_what_there_is_if_nothing_is_near) {
  const std::vector<std::string> clips = {"Idle", "Walk"};
  EXPECT_EQ(name_advice("Wakl", "clips", clips), "; did you mean 'Walk'?");
  EXPECT_EQ(name_advice("Swim", "clips", clips), "; its clips: 'Idle', 'Walk'");
  EXPECT_EQ(name_advice("Swim", "clips", {}), "; the model has no clips");
  const std::vector<std::string> many(30, "Bone");
  EXPECT_THAT(name_advice("Swim", "bones", many), testing::EndsWith("'Bone' and 20 more"));
}

}  // namespace
}  // namespace sunder::tools
