// Each file of ../shared/models/bad, read leniently and strictly.

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

struct Expectation {
  const char* file;
  StatusCode lenient, strict;
};

constexpr Expectation kExpected[] = {
    {"accessor_oob.gltf", StatusCode::index_out_of_range, StatusCode::index_out_of_range},
    {"empty.obj", StatusCode::empty_input, StatusCode::empty_input},
    {"empty_init_from.dae", StatusCode::malformed_file, StatusCode::malformed_file},
    {"face_oob.obj", StatusCode::malformed_file, StatusCode::malformed_file},
    {"garbage.fbx", StatusCode::malformed_file, StatusCode::malformed_file},
    {"huge_counts.off", StatusCode::malformed_file, StatusCode::malformed_file},
    {"joint_oob.gltf", StatusCode::ok, StatusCode::index_out_of_range},
    {"nan_position.gltf", StatusCode::non_finite_value, StatusCode::non_finite_value},
    {"node_cycle.gltf", StatusCode::not_a_tree, StatusCode::not_a_tree},
    {"skinweights_oob.x", StatusCode::index_out_of_range, StatusCode::index_out_of_range},
    {"truncated_fox.glb", StatusCode::malformed_file, StatusCode::malformed_file},
    {"weights_zero.gltf", StatusCode::ok, StatusCode::weights_not_normalized},
};

TEST(BadFiles, end_as_the_table_says) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  for (const Expectation& expected : kExpected) {
    SCOPED_TRACE(expected.file);
    const auto file = shared_models() / "bad" / expected.file;
    const auto lenient = load_character(file);
    EXPECT_EQ(lenient.error().code(), expected.lenient) << lenient.error().text();
    const Status refusal = load_character(file, strict()).error();
    EXPECT_EQ(refusal.code(), expected.strict) << refusal.text();
    if (lenient) {
      EXPECT_TRUE(validate_character(*lenient->character));
    }
  }
}

TEST(BadFiles, are_all_in_the_table) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  for (const auto& entry : std::filesystem::directory_iterator(shared_models() / "bad")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".urdf") continue;  // tests of robots
    EXPECT_TRUE(std::any_of(std::begin(kExpected), std::end(kExpected),
                            [&](const Expectation& one) { return name == one.file; }))
        << name;
  }
}

}  // namespace
}  // namespace sunder::test
