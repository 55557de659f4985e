#include "core/internal/nearest_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sunder {
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

TEST(NearestNames, namespaces_do_not_count) {
  const std::vector<std::string> bones = {"mixamorig:Hips", "rig|Spine", "Head:"};
  EXPECT_THAT(nearest_names("hips", bones), ElementsAre("mixamorig:Hips"));
  EXPECT_THAT(nearest_names("other:Spin", bones), ElementsAre("rig|Spine"));
  EXPECT_EQ(without_namespace("a:b|c"), "c");
  EXPECT_EQ(without_namespace("Head:"), "Head:");  // nothing follows, so that is its name
  EXPECT_EQ(without_namespace("Head"), "Head");
}

TEST(NearestNames, a_word_of_a_name_is_enough) {
  const std::vector<std::string> bones = {"Skeleton_neck_joint_1", "LeftUpLeg", "b_Tail02_013",
                                          "Arm.L"};
  EXPECT_THAT(nearest_names("Nek", bones), ElementsAre("Skeleton_neck_joint_1"));
  EXPECT_THAT(nearest_names("tial", bones), ElementsAre("b_Tail02_013"));
  EXPECT_THAT(nearest_names("Lge", bones), ElementsAre("LeftUpLeg"));
  EXPECT_THAT(nearest_names("Wing", bones), IsEmpty());
}

/// Files and logs may have names of megabytes; their product is no bound of the time.
TEST(NearestNames, long_names_are_compared_by_their_beginnings) {
  const std::string begin(100, 'a'), many(300'000, 'b');
  const std::vector<std::string> names = {many, begin + many, "x:" + begin + "c"};
  EXPECT_THAT(nearest_names(begin + many + "d", names), ElementsAre(names[1], names[2]));
  EXPECT_THAT(nearest_names(many + many, names), ElementsAre(many));
  EXPECT_THAT(nearest_names(std::string(1'000'000, 'z'), names), IsEmpty());
}

TEST(NearestNames, are_listed_as_one_says_them) {
  const std::vector<std::string> names = {"Walk", "Run", "Jump"};
  EXPECT_EQ(listed_names({}), "");
  EXPECT_EQ(listed_names({names.data(), 1}), "'Walk'");
  EXPECT_EQ(listed_names({names.data(), 2}), "'Walk' or 'Run'");
  EXPECT_EQ(listed_names(names), "'Walk', 'Run' or 'Jump'");
}

}  // namespace
}  // namespace sunder
