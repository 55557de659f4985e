// The page of `sunder validate`: its data as the page reads it, and the page in a browser.

#include <sunder/skinning/pose.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/machine/node_program.h"
#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"
#include "support/models/page_example.h"
#include "support/models/rigs.h"
#include "tools/page_parts/base64.h"
#include "tools/page_parts/model_section.h"
#include "tools/page_parts/page_template.h"
#include "tools/validation_page/page_data.h"
#include "tools/validation_page/write_page.h"

namespace sunder::test {
namespace {

using nlohmann::json;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

TEST(Base64, has_the_vectors_of_rfc_4648) {
  EXPECT_EQ(tools::base64({}), "");
  EXPECT_EQ(tools::base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(tools::base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(tools::base64(bytes_of("foo")), "Zm9v");
  EXPECT_EQ(tools::base64(bytes_of("foob")), "Zm9vYg==");
  EXPECT_EQ(tools::base64(bytes_of("fooba")), "Zm9vYmE=");
  EXPECT_EQ(tools::base64(bytes_of("foobar")), "Zm9vYmFy");
  EXPECT_EQ(tools::base64(bytes_of("\xff\xfe\xfd")), "//79");
}

/// Two rigs of two meshes, a random pose, and arrays with all kinds of values.
struct Pair {
  Character source = make_two_tubes(6, 8), target = make_two_tubes(9, 7);
  tools::PageInput input;

  Pair() {
    source.clips = make_tube(6, 8, 3).clips;
    input.source = &source;
    input.target = &target;
    input.source_title = "a \"quoted\" </script> name";
    input.target_title = "b";
    input.source_bone_from_target = bones_by_name(source.skeleton, target.skeleton);
    Random random(7);
    input.poses.push_back({"P", random_pose(source, random).model_from_bone});
    tools::PageArray array{"Any", "m", true, 0.25, {}};
    for (const Mesh& mesh : target.meshes)
      for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        array.values.push_back(static_cast<float>(random.uniform(-1, 1)));
    array.values[3] = std::numeric_limits<float>::quiet_NaN();
    input.arrays.push_back(array);
    input.series.push_back({"S", "m", {}, 0, {0, 0.5, 1}, {0.25, 4, 0}});
  }
};

/// What decode.js and skin.js make of the data.
json decoded(const tools::PageInput& input, double time) {
  const auto data = tools::page_data(input);
  EXPECT_TRUE(data) << data.error().text();
  const TemporaryFolder folder;
  const auto file = folder.write("data", tools::base64(*data));
  std::ostringstream arguments;
  arguments << "'" << file.string() << "' 0 " << time;
  const auto run = run_node_program("decode_page.mjs", arguments.str());
  EXPECT_TRUE(run && run->succeeded) << (run ? run->output : "");
  return json::parse(run->output);
}

ModelPose at_time(const Character& character, double time) {
  Pose pose = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(character.clips.at(0), time, pose));
  ModelPose model_pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model_pose));
  model_pose.morph_weights = character.rest_morph_weights;
  return model_pose;
}

/// The pose of the source on the bones of the target.
ModelPose retargeted(const Character& target, const ModelPose& pose,
                     const std::vector<Index>& source_bone) {
  ModelPose result = *bind_pose(target);
  for (std::size_t bone = 0; bone < source_bone.size(); ++bone)
    if (source_bone[bone] != kNone)
      result.model_from_bone[bone] = pose.model_from_bone[source_bone[bone]];
  return result;
}

void expect_near(const json& found, const std::vector<Vec3d>& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size() * 3);
  double worst = 0;
  for (std::size_t v = 0; v < expected.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      worst = std::max(worst, std::abs(found[v * 3 + axis].get<double>() - expected[v][axis]));
  EXPECT_LT(worst, tolerance);
}

void expect_same_mesh(const json& found, const Character& expected) {
  std::size_t v = 0, corner = 0;
  for (std::size_t m = 0; m < expected.meshes.size(); ++m) {
    const Mesh& mesh = expected.meshes[m];
    const auto first = static_cast<Index>(v);
    EXPECT_EQ(found["meshes"][m]["name"], mesh.name);
    EXPECT_EQ(found["meshes"][m]["first_vertex"], first);
    for (const Triangle& triangle : mesh.triangles)
      for (const Index vertex : triangle)
        ASSERT_EQ(found["indices"][corner++], first + vertex) << m;
    for (Index i = 0; i < mesh.vertex_count(); ++i, ++v) {
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_EQ(found["positions"][v * 3 + axis].get<float>(), mesh.positions[i][axis]);
      const auto influences = mesh.weights.of(i);
      ASSERT_EQ(found["influences"][v].size(), influences.size());
      for (const json& share : found["influences"][v]) {
        const Index bone = share["bone"];
        double weight = 0;
        for (const Influence& influence : influences)
          if (expected.skins[mesh.skin].bones[influence.slot] == bone)
            weight = static_cast<double>(influence.weight);
        ASSERT_EQ(share["weight"].get<double>(), weight);
      }
    }
  }
  EXPECT_EQ(found["indices"].size(), corner);
  EXPECT_EQ(found["positions"].size(), v * 3);
}

class PageData : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_node_packages({})) GTEST_SKIP() << "needs node (scripts/setup test)";
  }
};

TEST_F(PageData, is_read_by_the_page_as_it_was_written) {
  const Pair pair;
  const json page = decoded(pair.input, 0);
  expect_same_mesh(page["source"], pair.source);
  expect_same_mesh(page["target"], pair.target);
  EXPECT_EQ(page["source"]["title"], pair.input.source_title);
  const json& values = page["arrays"][0]["values"];
  ASSERT_EQ(values.size(), pair.input.arrays[0].values.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (v == 3)
      EXPECT_TRUE(values[v].is_null());
    else
      EXPECT_EQ(values[v].get<float>(), pair.input.arrays[0].values[v]);
  }
  EXPECT_EQ(page["arrays"][0]["threshold"], 0.25);
  EXPECT_EQ(page["arrays"][0]["signed"], true);
  EXPECT_EQ(page["series"][0]["values"], json({0.25, 4, 0}));
}

TEST_F(PageData, poses_both_models_as_the_library_does) {
  const Pair pair;
  // At keys of the clip, between them, and at its end.
  for (const double time : {0.0, 1.0 / 30, 0.35, 1.01, 2.0}) {
    const json page = decoded(pair.input, time);
    const ModelPose pose = at_time(pair.source, time);
    expect_near(page["source"]["posed_by_clip"], all_posed_positions(pair.source, pose), 1e-6);
    const ModelPose target = retargeted(pair.target, pose, pair.input.source_bone_from_target);
    expect_near(page["target"]["posed_by_clip"], all_posed_positions(pair.target, target), 1e-6);
  }
  const ModelPose given{pair.input.poses[0].model_from_bone, pair.source.rest_morph_weights};
  expect_near(decoded(pair.input, 0)["source"]["posed"][0], all_posed_positions(pair.source, given),
              1e-9);
}

/// A clip in which every kind of channel moves the first mesh, with keys at random times.
Clip random_clip(const Character& character, Random& random) {
  Clip clip{"All", 2.0f, {}};
  const Interpolation interpolations[] = {Interpolation::linear, Interpolation::step,
                                          Interpolation::cubic_spline};
  std::size_t number = 0;
  const auto add = [&](ChannelTarget target, Index index, Index width) {
    Channel channel{target, index, width, interpolations[number++ % 3], {}, {}};
    for (float time = 0; time < 2; time += static_cast<float>(random.uniform(0.1, 0.6)))
      channel.times.push_back(time);
    channel.times.push_back(2.0f);
    const std::size_t parts = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
    for (std::size_t i = 0; i < channel.times.size() * parts * width; ++i)
      channel.values.push_back(static_cast<float>(random.uniform(-1, 1)));
    clip.channels.push_back(channel);
  };
  for (Index bone = 0; bone < character.skeleton.bones.size(); ++bone) {
    add(ChannelTarget::rotation, bone, 4);
    add(ChannelTarget::translation, bone, 3);
    add(ChannelTarget::scale, bone, 3);
    ++number;  // so that each part has each interpolation
  }
  add(ChannelTarget::morph_weights, 0, static_cast<Index>(character.rest_morph_weights.size()));
  return clip;
}

TEST_F(PageData, poses_every_kind_of_channel_and_morph_targets_as_the_library_does) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    Pair pair;
    pair.source = pair.target = make_tube(6, 8, 5);
    pair.input.source_bone_from_target = bones_by_name(pair.source.skeleton, pair.target.skeleton);
    pair.source.clips = {random_clip(pair.source, random)};
    ASSERT_TRUE(validate_character(pair.source)) << validate_character(pair.source).text();
    pair.input.poses.clear();
    pair.input.arrays.clear();
    const double time = random.uniform(0, 2.2);
    const json page = decoded(pair.input, time);
    Pose local = *local_rest_pose(pair.source);
    ASSERT_TRUE(sample_clip(pair.source.clips[0], time, local));
    ModelPose pose = at_time(pair.source, time);
    pose.morph_weights = local.morph_weights;
    EXPECT_NE(pose.morph_weights, pair.source.rest_morph_weights);
    // The library interpolates in single precision, the page in double.
    expect_near(page["source"]["posed_by_clip"], all_posed_positions(pair.source, pose), 1e-5);
    expect_near(page["target"]["posed_by_clip"], all_posed_positions(pair.source, pose), 1e-5);
  }
}

TEST_F(PageData, a_bone_without_a_source_follows_its_parent) {
  Pair pair;
  const auto& bones = pair.target.skeleton.bones;
  Index last = 0;
  for (Index bone = 0; bone < bones.size(); ++bone)
    if (bones[bone].parent != kNone) last = bone;
  const Index parent = bones[last].parent;
  ASSERT_NE(parent, kNone);
  pair.input.source_bone_from_target[last] = kNone;
  const ModelPose given{pair.input.poses[0].model_from_bone, pair.source.rest_morph_weights};
  ModelPose expected = retargeted(pair.target, given, pair.input.source_bone_from_target);
  const ModelPose bind = *bind_pose(pair.target);
  expected.model_from_bone[last] = expected.model_from_bone[parent] *
                                   bind.model_from_bone[parent].inverse() *
                                   bind.model_from_bone[last];
  expect_near(decoded(pair.input, 0)["target"]["posed"][0],
              all_posed_positions(pair.target, expected), 1e-9);
}

TEST(PageDataFaults, arrays_that_do_not_fit_are_refused) {
  const auto status_of = [](auto change) {
    Pair pair;
    change(pair.input);
    return tools::page_data(pair.input).error().code();
  };
  EXPECT_EQ(status_of([](tools::PageInput&) {}), StatusCode::ok);
  EXPECT_EQ(status_of([](auto& input) { input.arrays[0].values.pop_back(); }),
            StatusCode::size_mismatch);
  EXPECT_EQ(status_of([](auto& input) { input.poses[0].model_from_bone.pop_back(); }),
            StatusCode::size_mismatch);
  EXPECT_EQ(status_of([](auto& input) { input.series[0].times.pop_back(); }),
            StatusCode::size_mismatch);
  EXPECT_EQ(status_of([](auto& input) { input.series[0].clip = 9; }),
            StatusCode::index_out_of_range);
  EXPECT_EQ(status_of([](auto& input) { input.source_bone_from_target.pop_back(); }),
            StatusCode::size_mismatch);
  EXPECT_EQ(status_of([](auto& input) { input.source_bone_from_target[0] = 99; }),
            StatusCode::index_out_of_range);
}

bool has_chromium() { return std::system("command -v chromium > /dev/null 2>&1") == 0; }

TEST(ValidationPage, works_in_a_browser) {
  if (tools::validation_page_template().empty())
    GTEST_SKIP() << "built without the page (scripts/setup page)";
  if (!has_node_packages({"puppeteer-core"}) || !has_chromium())
    GTEST_SKIP() << "needs chromium and puppeteer-core (scripts/setup test)";
  PageExample example;
  make_page_example(example);
  const TemporaryFolder folder;
  const auto file = folder.path() / "page.html";
  ASSERT_TRUE(tools::write_validation_page(file, example.input));
  EXPECT_LT(std::filesystem::file_size(file), 3u << 20);

  const auto run = run_node_program("validation_page.mjs", "'" + file.string() + "'");
  ASSERT_TRUE(run && run->succeeded) << (run ? run->output : "");
  const json facts = json::parse(run->output);
  EXPECT_EQ(facts["errors"], json::array());
  EXPECT_EQ(facts["requests"], json::array());
  EXPECT_EQ(facts["listed_findings"], 3);
  ASSERT_EQ(facts["views"].size(), 2u);
  for (std::size_t view = 0; view < 2; ++view) {
    EXPECT_GT(facts["views"][view]["share"], 0.05);
    EXPECT_LT(facts["outline_distance"][view], 2.5) << "pixels between shader and processor";
  }
  EXPECT_GT(facts["camera_moved"], 0.1);
  EXPECT_LT(facts["worst"]["from_middle"], 1.0);
  const std::string vertex = std::to_string(facts["worst"]["vertex"].get<int>());
  EXPECT_THAT(facts["readout"].get<std::string>(), HasSubstr("vertex " + vertex));
  EXPECT_GT(facts["changed_by_heat_map"], 0.02);
  EXPECT_GT(facts["changed_by_log"], 0.02);
  EXPECT_GT(facts["changed_by_bone"], 0.02);
  EXPECT_GT(facts["changed_by_layout"], 0.02);
  EXPECT_EQ(facts["viewports_overlaid"], 1);
  EXPECT_EQ(facts["pose_given"], 0) << "the worst pose is shown first";
  EXPECT_EQ(facts["chart"]["lines"], 2) << "largest deviation and RMS";
  EXPECT_EQ(facts["chart"]["thresholds"], 1);
  EXPECT_THAT(facts["chart"]["title"].get<std::string>(), HasSubstr("RMS up to"));
  const json& sought = facts["sought"];
  EXPECT_NEAR(sought["share"].get<double>(), 0.25, 0.01);
  EXPECT_NEAR(sought["cursor"].get<double>(), sought["share"].get<double>(), 1e-6);
  EXPECT_TRUE(sought["pose"].is_null()) << "the clip is shown, not the worst pose";
  EXPECT_EQ(sought["is_playing"], false);
  EXPECT_THAT(sought["clock"].get<std::string>(), HasSubstr(" at 0.50 s"));
  EXPECT_EQ(facts["is_playing"], false);
  EXPECT_EQ(facts["markers"], 8);
  EXPECT_EQ(facts["dark"], true);
  EXPECT_EQ(facts["runs_other_scripts"], false) << "the policy names the page's own scripts alone";
  EXPECT_EQ(facts["unseen"], 0) << "control characters of names are shown as escapes";
}

}  // namespace
}  // namespace sunder::test
