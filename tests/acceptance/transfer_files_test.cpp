// Weights transferred between files: each rigged model to itself and to a finer one.

#include <sunder/io/character_file.h>
#include <sunder/validation/transfer.h>

#include <algorithm>
#include <cctype>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/changed_surfaces.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

/// Largest and mean difference of weights, over all vertices.
struct Difference {
  double largest = 0, mean = 0;
};

Difference difference(const Character& a, const Character& b) {
  Difference result;
  double count = 0;
  for (Index m = 0; m < a.meshes.size(); ++m)
    for (Index v = 0; v < a.meshes[m].vertex_count(); ++v, ++count) {
      const double distance = test::weight_distance(a, m, v, b, m, v);
      result.largest = std::max(result.largest, distance);
      result.mean += distance;
    }
  result.mean /= std::max(count, 1.0);
  return result;
}

class TransferFiles : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(TransferFiles, give_a_model_its_own_weights_back) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character& character = *loaded->character;
  const auto result = transfer_weights(character, character);
  ASSERT_TRUE(result) << result.error().text();
  EXPECT_EQ(result->matched_share(), 1.0);
  EXPECT_LE(difference(result->character, character).largest, 4e-7);  // the sums of the file
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "again.glb";
  ASSERT_TRUE(save_glb(file, result->character, *loaded));
  const auto again = load_character(file);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_LE(difference(*again->character, character).largest, 4e-7);
}

TEST_P(TransferFiles, give_a_finer_model_interpolated_weights) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character truth = test::subdivided(*loaded->character);
  const auto result = transfer_weights(*loaded->character, truth);
  ASSERT_TRUE(result) << result.error().text();
  // At sharp folds the mean normal of a new point may disagree with every face that it lies on.
  EXPECT_GE(result->matched_share(), 0.998);
  EXPECT_LE(difference(result->character, truth).mean, 1e-3);
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = std::to_string(info.index) + "_" + info.param.stem().string();
  for (char& letter : name)
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Models, TransferFiles, testing::ValuesIn(test::rigged_gltf_models()),
                         name_of);

}  // namespace
}  // namespace sunder
