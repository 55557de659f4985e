// Ragdolls of models from files, in their rest pose and in the middle of a clip.

#include <sunder/io/character_file.h>
#include <sunder/ragdoll/ragdoll.h>
#include <sunder/skinning/pose.h>

#include <cctype>

#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/ragdoll_laws.h"

namespace sunder::test {
namespace {

class RagdollOfFile : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(RagdollOfFile, keeps_its_laws) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character& character = *loaded->character;
  std::vector<ModelPose> poses = {*rest_pose(character)};
  if (!character.clips.empty())
    poses.push_back(*make_pose(character, ClipPose{0u, 0.4 * double{character.clips[0].duration}}));
  Random random(1);
  for (const ModelPose& pose : poses) {
    const auto ragdoll = make_ragdoll(character, pose);
    ASSERT_TRUE(ragdoll) << ragdoll.error().text();
    EXPECT_LE(ragdoll->bodies.size(), 16u);
    expect_ragdoll_laws(character, pose, *ragdoll, random);
  }
}

INSTANTIATE_TEST_SUITE_P(models, RagdollOfFile, testing::ValuesIn(rigged_gltf_models()),
                         [](const auto& model) {
                           std::string name = model.param.stem().string();
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name + "_" + std::to_string(model.index);
                         });

}  // namespace
}  // namespace sunder::test
