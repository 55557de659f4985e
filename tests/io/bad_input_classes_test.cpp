// One test per class of bad input, each with what a strict and a lenient reading do;
// docs/method/io.md has the rules. Files are generated.

#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
using Kind = LoadNote::Kind;

GltfBuilder strip_with(const char* pointer, Json value) {
  GltfBuilder builder = skinned_strip();
  builder.json[Json::json_pointer(pointer)] = std::move(value);
  return builder;
}

GltfBuilder strip_with_attribute(const char* name, const std::vector<float>& values,
                                 const char* type) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)[name] = builder.add(values, type);
  return builder;
}

/// Refused by both, with this code and a text that contains this.
void expect_refused(const GltfBuilder& builder, StatusCode code, const char* text = "") {
  for (const LoadOptions& options : {LoadOptions{}, strict()}) {
    const Status error = builder.load(options).error();
    EXPECT_EQ(error.code(), code) << error.text();
    EXPECT_NE(error.text().find(text), std::string::npos) << error.text();
  }
}

/// Refused if strict; otherwise accepted, with such a note.
LoadedCharacter expect_repaired(const GltfBuilder& builder, StatusCode code, Kind kind,
                                const char* text) {
  const Status error = builder.load(strict()).error();
  EXPECT_EQ(error.code(), code) << error.text();
  auto loaded = builder.load();
  EXPECT_TRUE(loaded) << loaded.error().text();
  if (!loaded) return {};
  EXPECT_TRUE(has_note(loaded->report, kind, text)) << text;
  EXPECT_TRUE(validate_character(*loaded->character));
  return std::move(*loaded);
}

LoadedCharacter expect_accepted(const GltfBuilder& builder) {
  auto loaded = builder.load(strict());
  EXPECT_TRUE(loaded) << loaded.error().text();
  if (!loaded) return {};
  EXPECT_TRUE(validate_character(*loaded->character));
  return std::move(*loaded);
}

TEST(BadInputClasses, c01_not_the_claimed_format) {
  EXPECT_EQ(load_bytes("a.glb", std::vector<std::byte>(64)).error().code(),
            StatusCode::unsupported_format);
  EXPECT_EQ(load_bytes("a.gltf", skinned_strip().glb()).error().code(),
            StatusCode::unsupported_format);
  EXPECT_EQ(load_bytes("a.fbx", skinned_strip().glb()).error().code(), StatusCode::malformed_file);
  EXPECT_EQ(load_bytes("a.xyz", skinned_strip().glb()).error().code(),
            StatusCode::unsupported_format);
}

TEST(BadInputClasses, c02_truncated) {
  const auto glb = skinned_strip().glb();
  for (const std::size_t size :
       {std::size_t{13}, std::size_t{40}, glb.size() / 2, glb.size() - 1}) {
    const Status error =
        load_bytes("a.glb", {glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)}).error();
    EXPECT_EQ(error.code(), StatusCode::malformed_file);
    EXPECT_NE(error.text().find(std::to_string(size)), std::string::npos) << error.text();
  }
}

TEST(BadInputClasses, c03_small_file_that_claims_gigabytes) {
  expect_refused(strip_with("/buffers", {{{"byteLength", 4'000'000'000u}}}),
                 StatusCode::malformed_file, "declared");
  expect_refused(strip_with("/accessors/0",
                            {{"componentType", 5126}, {"count", 4'000'000'000u}, {"type", "VEC3"}}),
                 StatusCode::limit_exceeded, "/accessors/0/count");
}

TEST(BadInputClasses, c04_accessor_or_view_beyond_its_buffer) {
  expect_refused(strip_with("/accessors/0/byteOffset", 100'000), StatusCode::index_out_of_range,
                 "/accessors/0");
  expect_refused(strip_with("/bufferViews/1/byteLength", 100'000), StatusCode::index_out_of_range,
                 "/bufferViews/1");
}

TEST(BadInputClasses, c05_overflow_of_count_times_stride) {
  GltfBuilder builder = strip_with("/accessors/0/count", 4'294'967'290u);
  builder.json["bufferViews"][0]["byteStride"] = 4'294'967'295u;
  expect_refused(builder, StatusCode::index_out_of_range, "/accessors/0");
}

TEST(BadInputClasses, c06_negative_fractional_and_huge_counts) {
  for (const Json& count : {Json(-1), Json(1.5), Json("many"), Json(0)})
    expect_refused(strip_with("/accessors/0/count", count), StatusCode::malformed_file,
                   "/accessors/0/count");
  expect_refused(strip_with("/accessors/0/count", 9.0e15), StatusCode::limit_exceeded,
                 "/accessors/0/count");
}

TEST(BadInputClasses, c07_deep_nesting) {
  GltfBuilder builder = skinned_strip();
  Json& nodes = builder.json["nodes"];
  for (std::size_t i = 0; i < 5'000; ++i) nodes.push_back({{"children", {nodes.size() + 1}}});
  nodes.push_back(Json::object());
  expect_refused(builder, StatusCode::limit_exceeded, "nested deeper than 1024");
  EXPECT_EQ(load_text("{\"asset\":" + std::string(100'000, '[')).error().code(),
            StatusCode::limit_exceeded);
}

TEST(BadInputClasses, c08_cycle_and_two_parents) {
  expect_refused(strip_with("/nodes/2/children", {1}), StatusCode::not_a_tree, "ancestor");
  expect_refused(strip_with("/nodes/0/children", {2}), StatusCode::not_a_tree,
                 "node 2 is already a child of node 0");
}

TEST(BadInputClasses, c09_references_outside_the_folder) {
  for (const char* const uri : {"../outside.bin", "/etc/passwd", "http://example.com/a.bin",
                                "package://robot/a.bin", "%2e%2e/outside.bin"})
    EXPECT_EQ(load_text(skinned_strip().text_with_uri(uri)).error().code(),
              StatusCode::path_not_allowed)
        << uri;
  // An image is no part of a character: it is not read, and only a strict reading refuses it.
  expect_repaired(strip_with("/images", {{{"uri", "../outside.png"}}}),
                  StatusCode::path_not_allowed, Kind::dropped, "outside the model's folder");
}

TEST(BadInputClasses, c10_missing_buffer_or_image) {
  EXPECT_EQ(load_text(skinned_strip().text_with_uri("absent.bin")).error().code(),
            StatusCode::file_not_found);
  const LoadedCharacter loaded = expect_accepted(strip_with("/images", {{{"uri", "absent.png"}}}));
  EXPECT_TRUE(has_note(loaded.report, Kind::information, "does not exist"));
}

TEST(BadInputClasses, c11_index_out_of_range) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"][0]["primitives"][0]["indices"] =
      builder.add(std::vector<std::uint16_t>{0, 1, 2, 1, 2, 99, 1, 3, 2}, "SCALAR");
  const LoadedCharacter loaded =
      expect_repaired(builder, StatusCode::index_out_of_range, Kind::dropped,
                      "triangles refer to vertices that do not exist (first: triangle 1)");
  EXPECT_EQ(loaded.character->meshes[0].triangle_count(), 2u);
}

TEST(BadInputClasses, c12_degenerate_and_duplicate_triangles) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"][0]["primitives"][0]["indices"] =
      builder.add(std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2, 1, 3, 2, 4, 4, 5}, "SCALAR");
  const LoadedCharacter loaded = expect_accepted(builder);
  ASSERT_EQ(loaded.character->meshes[0].triangle_count(), 4u);
  const auto counts = count_topology(*loaded.character);
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->degenerate_triangles, 1u);
  EXPECT_GT(counts->non_manifold_edges, 0u);
  auto model = TornModel::create(loaded.character);
  ASSERT_TRUE(model) << "they are kept, and tears go around them";
}

TEST(BadInputClasses, c13_position_not_finite) {
  std::vector<float> positions(3 * kStripVertices, 0.5f);
  positions[3 * 4 + 1] = kNotANumber;
  GltfBuilder builder = strip_with_attribute("POSITION", positions, "VEC3");
  expect_refused(builder, StatusCode::non_finite_value, "vertex 4");
  EXPECT_EQ(builder.load().error().index(), 4u);
}

std::vector<float> strip_weights() {
  std::vector<float> weights;
  for (std::size_t i = 0; i < kStripVertices; ++i)
    weights.insert(weights.end(), {0.5f, 0.5f, 0.0f, 0.0f});
  return weights;
}

void expect_weights_repaired(const std::vector<float>& weights, StatusCode code, Kind kind,
                             const char* text) {
  const LoadedCharacter loaded =
      expect_repaired(strip_with_attribute("WEIGHTS_0", weights, "VEC4"), code, kind, text);
  ASSERT_TRUE(loaded.character);
  const SkinWeights& read = loaded.character->meshes[0].weights;
  for (std::uint32_t vertex = 0; vertex < kStripVertices; ++vertex) {
    float sum = 0;
    for (const Influence& influence : read.of(vertex)) sum += influence.weight;
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
  }
}

TEST(BadInputClasses, c14_weight_not_finite) {
  std::vector<float> weights = strip_weights();
  weights[5] = kNotANumber;
  expect_weights_repaired(weights, StatusCode::non_finite_value, Kind::repaired,
                          "not finite and became zero (first: vertex 1)");
}

TEST(BadInputClasses, c15_weight_negative_or_above_one) {
  std::vector<float> weights = strip_weights();
  weights[4] = -0.5f;
  expect_weights_repaired(weights, StatusCode::weights_not_normalized, Kind::repaired,
                          "negative and became zero");
  weights[4] = 1e30f;
  expect_weights_repaired(weights, StatusCode::weights_not_normalized, Kind::repaired,
                          "did not sum to one");
}

TEST(BadInputClasses, c16_weights_that_do_not_sum_to_one) {
  std::vector<float> weights = strip_weights();
  weights[8] = 0.51f;
  expect_weights_repaired(weights, StatusCode::weights_not_normalized, Kind::repaired,
                          "off by up to 0.01");
  weights[8] = 0.500001f;  // rounding: normalised without a word
  expect_accepted(strip_with_attribute("WEIGHTS_0", weights, "VEC4"));
}

TEST(BadInputClasses, c17_vertex_without_weight) {
  std::vector<float> weights = strip_weights();
  weights[12] = weights[13] = 0.0f;
  expect_weights_repaired(weights, StatusCode::weights_not_normalized, Kind::repaired,
                          "bound to the skin's root (first: vertex 3)");
}

TEST(BadInputClasses, c18_joint_beyond_the_skin) {
  std::vector<std::uint8_t> joints;
  for (std::size_t i = 0; i < kStripVertices; ++i) joints.insert(joints.end(), {0, 1, 0, 0});
  joints[4 * 6 + 1] = 9;
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)["JOINTS_0"] = builder.add(joints, "VEC4");
  expect_repaired(builder, StatusCode::index_out_of_range, Kind::dropped,
                  "joints that the skin does not have (first: vertex 6)");
}

TEST(BadInputClasses, c19_sets_of_joints_and_weights_that_do_not_match) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder).erase("WEIGHTS_0");
  expect_refused(builder, StatusCode::size_mismatch, "JOINTS_0 and WEIGHTS_0");
  expect_refused(strip_with_attribute("WEIGHTS_0", std::vector<float>(4 * 7, 0.25f), "VEC4"),
                 StatusCode::size_mismatch, "7 elements for 10 vertices");
}

TEST(BadInputClasses, c20_every_number_format_and_any_number_of_influences) {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> shorts, joints, more_joints;
  for (std::size_t i = 0; i < kStripVertices; ++i) {
    bytes.insert(bytes.end(), {155, 100, 0, 0});
    shorts.insert(shorts.end(), {20'000, 25'535, 0, 0});
    joints.insert(joints.end(), {0, 1, 0, 0});
    more_joints.insert(more_joints.end(), {2, 0, 0, 0});
  }
  GltfBuilder builder = skinned_strip();
  builder.json["skins"][0]["joints"].push_back(0);
  builder.json["skins"][0].erase("inverseBindMatrices");
  strip_attributes(builder)["JOINTS_0"] = builder.add(joints, "VEC4");
  strip_attributes(builder)["WEIGHTS_0"] = builder.add(bytes, "VEC4", true);
  EXPECT_EQ(expect_accepted(builder).character->meshes[0].weights.of(0).size(), 2u);
  strip_attributes(builder)["WEIGHTS_0"] = builder.add(shorts, "VEC4", true);
  strip_attributes(builder)["JOINTS_1"] = builder.add(more_joints, "VEC4");
  std::vector<std::uint16_t> rest;
  for (std::size_t i = 0; i < kStripVertices; ++i) rest.insert(rest.end(), {20'000, 0, 0, 0});
  strip_attributes(builder)["WEIGHTS_1"] = builder.add(rest, "VEC4", true);
  EXPECT_EQ(expect_accepted(builder).character->meshes[0].weights.of(0).size(), 3u);
}

TEST(BadInputClasses, c21_no_or_too_few_bind_matrices) {
  GltfBuilder builder = skinned_strip();
  builder.json["skins"][0].erase("inverseBindMatrices");
  const LoadedCharacter loaded = expect_accepted(builder);
  EXPECT_EQ(loaded.character->skins[0].bone_from_bind[1].matrix(), Affine3f::Identity().matrix());
  builder.json["skins"][0]["inverseBindMatrices"] =
      builder.add(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
  expect_refused(builder, StatusCode::size_mismatch, "1 matrices for 2 joints");
}

TEST(BadInputClasses, c22_bind_matrices_and_scales_without_inverse) {
  std::vector<float> binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  GltfBuilder builder = skinned_strip();
  builder.json["skins"][0]["inverseBindMatrices"] = builder.add(binds, "MAT4");
  EXPECT_TRUE(has_note(expect_accepted(builder).report, Kind::information, "not invertible"));
  binds[21] = kNotANumber;
  builder.json["skins"][0]["inverseBindMatrices"] = builder.add(binds, "MAT4");
  expect_refused(builder, StatusCode::non_finite_value, "inverse bind matrix 1");
  for (const Json& scale : {Json{0, 0, 0}, Json{-1, 1, 1}})
    expect_accepted(strip_with("/nodes/2/scale", scale));
}

TEST(BadInputClasses, c23_names_and_skins_are_told_apart_by_index) {
  GltfBuilder builder = skinned_strip();
  for (Json& node : builder.json["nodes"]) node["name"] = "bone";
  Json second = builder.json["skins"][0];
  second.erase("inverseBindMatrices");
  builder.json["skins"].push_back(second);
  builder.json["nodes"].push_back({{"name", ""}, {"mesh", 0}, {"skin", 1}});
  builder.json["scenes"][0]["nodes"] = {0, 3};  // the joints are in no scene
  const LoadedCharacter loaded = expect_accepted(builder);
  ASSERT_EQ(loaded.character->meshes.size(), 2u);
  EXPECT_NE(loaded.character->meshes[0].skin, loaded.character->meshes[1].skin);
  EXPECT_NE(loaded.character->skins[0].bone_from_bind[1].matrix(),
            loaded.character->skins[1].bone_from_bind[1].matrix());
  EXPECT_TRUE(has_note(loaded.report, Kind::information, "without a unique name"));
  EXPECT_TRUE(has_note(loaded.report, Kind::information, "joints outside the scene"));
  EXPECT_EQ(
      load_text("{\"asset\": {\"version\": \"2.0\", \"generator\": \"\xFF\"}}").error().code(),
      StatusCode::malformed_file);
}

GltfBuilder animated(const std::vector<float>& times, const char* interpolation,
                     std::size_t values) {
  GltfBuilder builder = skinned_strip();
  const std::size_t input = builder.add(times, "SCALAR"),
                    output = builder.add(std::vector<float>(3 * values, 1.0f), "VEC3");
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "scale"}}}}}},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}}};
  return builder;
}

TEST(BadInputClasses, c24_animations_that_cannot_be_played) {
  for (const GltfBuilder& builder :
       {animated({1, 0}, "LINEAR", 2), animated({-1, 0}, "LINEAR", 2),
        animated({0, kNotANumber}, "LINEAR", 2), animated({0, 1}, "BEZIER", 2),
        animated({0, 1}, "LINEAR", 3), animated({0, 1}, "CUBICSPLINE", 2)}) {
    const LoadedCharacter loaded =
        expect_repaired(builder, StatusCode::malformed_file, Kind::dropped, "channel 0");
    EXPECT_TRUE(loaded.character->clips[0].channels.empty());
    EXPECT_EQ(loaded.character->meshes.size(), 1u);
  }
  expect_accepted(animated({0}, "LINEAR", 1));  // a clip of no length
}

TEST(BadInputClasses, c25_bad_requests_leave_the_model_as_it_is) {
  const LoadedCharacter loaded = expect_accepted(skinned_strip());
  auto model = TornModel::create(loaded.character);
  ASSERT_TRUE(model);
  const ModelPose pose = *rest_pose(*loaded.character);
  const std::uint64_t before = model->digest();
  const double bad = std::numeric_limits<double>::quiet_NaN();
  const auto expect_failure = [&](const auto& result, StatusCode code) {
    EXPECT_FALSE(result);
    EXPECT_EQ(result.error().code(), code) << result.error().text();
    EXPECT_EQ(model->digest(), before);
  };
  PlaneCut cut;
  cut.point = {0.5, 1.0, 0.0};
  cut.normal = Vec3d::Zero();
  expect_failure(model->cut(pose, cut), StatusCode::invalid_argument);
  cut.normal = {0, bad, 0};
  expect_failure(model->cut(pose, cut), StatusCode::non_finite_value);
  Bore bore;
  bore.radius = -1.0;
  expect_failure(model->drill(pose, bore), StatusCode::invalid_argument);
  expect_failure(model->tear(pose, Stroke{}), StatusCode::invalid_argument);
  ModelPose short_pose = pose;
  short_pose.model_from_bone.pop_back();
  cut.normal = {0, 1, 0};
  expect_failure(model->cut(short_pose, cut), StatusCode::size_mismatch);
  EXPECT_FALSE(model->undo());
  cut.point = {0, 99, 0};
  const auto miss = model->cut(pose, cut);  // misses the mesh
  ASSERT_TRUE(miss);
  EXPECT_EQ(miss->faces_crossed, 0u);
  EXPECT_EQ(model->digest(), before);
}

}  // namespace
}  // namespace sunder::test
