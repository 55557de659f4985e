// Particles of every available rigged file: decomposed coarsely and finely, torn, and undone.
#include <sunder/io/character_file.h>
#include <sunder/particles/particle_set.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/particle_laws.h"

namespace sunder {
namespace {

using test::Random;
using testing::IsEmpty;

void tear_and_undo(const LoadedCharacter& loaded, double range) {
  auto model = TornModel::create(loaded.character);
  ASSERT_TRUE(model) << model.error().text();
  Random random(3);
  const ModelPose pose = test::random_pose(*loaded.character, random, 0.4, 1.1);
  auto set = ParticleSet::create(*model, *bind_pose(*loaded.character), {range});
  ASSERT_TRUE(set) << set.error().text();
  ASSERT_THAT(test::broken_particles(*model, *set), IsEmpty());
  EXPECT_EQ(set->report().covered, set->report().points);
  const test::ParticleState before = test::state_of(*model, *set, pose);
  for (int i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    ChangeRecord change;
    const std::uint32_t done = model->undo_count();
    const auto report = test::play(*model, test::random_operation(*model, random), &change);
    ASSERT_TRUE(report) << report.error().text();
    if (model->undo_count() == done) continue;
    ASSERT_TRUE(set->follow(*model, {&change, 1}));
    ASSERT_THAT(test::broken_sides(*set, {&change, 1}), IsEmpty());
    while (set->settle(*model)) {
    }
    ASSERT_THAT(test::broken_particles(*model, *set), IsEmpty());
    ASSERT_THAT(test::broken_sides(*set, {&change, 1}), IsEmpty());
  }
  while (model->undo_count() > 0) ASSERT_TRUE(model->undo());
  ASSERT_TRUE(set->follow(*model, {}));
  EXPECT_EQ(test::difference(test::state_of(*model, *set, pose), before), "");
}

///
/// @return number of files that could be loaded; some of assimp's are broken on purpose.
std::size_t tear_and_undo_all(const std::vector<std::filesystem::path>& files) {
  std::size_t loaded_count = 0;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const auto loaded = load_character(file);
    if (!loaded) continue;
    ++loaded_count;
    for (const double range : {0.1, 0.03}) tear_and_undo(*loaded, range);
  }
  return loaded_count;
}

const std::vector<std::string> kExtensions = {".glb", ".gltf",    ".fbx", ".dae", ".x",
                                              ".b3d", ".md5mesh", ".mdl", ".ms3d"};

TEST(RealParticles, keep_the_laws_on_rigged_models) {
  const auto files = test::rigged_models(kExtensions);
  ASSERT_GE(files.size(), 8u);
  EXPECT_EQ(tear_and_undo_all(files), files.size());
}

TEST(RealParticles, keep_the_laws_on_the_models_of_assimp) {
  if (test::assimp_models().empty()) GTEST_SKIP() << "needs Debian's assimp-testmodels";
  EXPECT_GE(tear_and_undo_all(test::files_below(test::assimp_models(), kExtensions)), 80u);
}

}  // namespace
}  // namespace sunder
