#include <sunder/bodies/convex_hulls.h>

#include <map>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "tear/bodies/internal/main_bones.h"

namespace sunder {
namespace {

TEST(MainBone, has_the_largest_sum_of_weights_and_of_several_the_first_slot) {
  test::Random random(3);
  constexpr std::uint32_t kSlots = 40;
  Skin skin;
  for (std::uint32_t slot = 0; slot < kSlots; ++slot) skin.bones.push_back(100 + slot);
  bodies::MainBones main_bones(kSlots);
  for (int i = 0; i < 2000; ++i) {
    SkinWeights weights;
    std::map<std::uint32_t, float> sums;
    for (int vertex = 0; vertex < 3; ++vertex) {
      std::map<std::uint32_t, float> of_vertex;
      for (std::uint32_t k = 1 + random.index(i % 2 == 0 ? 4 : 12); k > 0; --k)
        of_vertex[random.index(kSlots)] = 0.125f * static_cast<float>(1 + random.index(4));
      std::vector<Influence> influences;
      for (const auto& [slot, weight] : of_vertex) {
        influences.push_back({slot, weight});
        sums[slot] += weight;  // eighths: exact in any order
      }
      weights.append(influences);
    }
    auto most = sums.begin();
    for (auto sum = sums.begin(); sum != sums.end(); ++sum)
      if (sum->second > most->second) most = sum;
    ASSERT_EQ(main_bone({0, 1, 2}, weights, skin), 100 + most->first) << i;
    ASSERT_EQ(main_bones.of({0, 1, 2}, weights, skin), 100 + most->first) << i;
  }
}

}  // namespace
}  // namespace sunder
