// load_character() on glTF: any input results in a clear refusal or a valid character.

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

Status error_of(const GltfBuilder& builder) { return builder.load().error(); }

void overwrite_u32(std::vector<std::byte>& bytes, std::size_t offset, std::uint32_t value) {
  std::memcpy(bytes.data() + offset, &value, 4);
}

TEST(LoadGltfBadInput, vrm_is_glb) {
  const TemporaryFolder folder;
  const auto glb = skinned_strip().glb();
  const auto loaded = load_character(folder.write(
      "A.VRM", std::string_view(reinterpret_cast<const char*>(glb.data()), glb.size())));
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
}

TEST(LoadGltfBadInput, other_content_than_gltf_is_refused) {
  const TemporaryFolder folder;
  const auto code_of = [&](const char* name, const std::string& content) {
    return load_character(folder.write(name, content)).error().code();
  };
  EXPECT_EQ(code_of("a.glb", ""), StatusCode::malformed_file);
  EXPECT_EQ(code_of("a.glb", "xof 0303txt 0032"), StatusCode::unsupported_format);
  EXPECT_EQ(code_of("a.gltf", "xof 0303txt 0032"), StatusCode::unsupported_format);
  EXPECT_EQ(code_of("a.gltf", "glTF"), StatusCode::unsupported_format);
  EXPECT_EQ(code_of("a.glb", skinned_strip().text()), StatusCode::unsupported_format);
  EXPECT_EQ(code_of("a.vrm", skinned_strip().text()), StatusCode::unsupported_format);
  EXPECT_EQ(code_of("a.gltf", "{\"asset\": {\"version\": \"2.0\"}"), StatusCode::malformed_file);
  EXPECT_EQ(code_of("a.gltf", "{\"asset\": {\"version\": \"1.0\"}}"),
            StatusCode::unsupported_format);
  EXPECT_EQ(code_of("a.gltf", "{\"asset\": {\"version\": \"2.0\"}}"), StatusCode::empty_input);
  const std::string clips = R"({"asset": {"version": "2.0"}, "animations": [{}, {}]})";
  EXPECT_EQ(load_character(folder.write("clips.gltf", clips)).error().text(),
            "the file has 2 clips but no mesh that they move");
  EXPECT_EQ(load_character(folder.path() / "absent.glb").error().code(),
            StatusCode::file_not_found);
}

TEST(LoadGltfBadInput, truncated_files_are_refused_at_every_length) {
  const auto glb = skinned_strip().glb();
  for (std::size_t size = 0; size < glb.size(); size += 7)
    EXPECT_FALSE(
        load_bytes("cut.glb", {glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)})
            .has_value())
        << size;
}

TEST(LoadGltfBadInput, lengths_are_not_believed) {
  auto glb = skinned_strip().glb();
  overwrite_u32(glb, 8, 0xFFFFFFF0u);
  EXPECT_EQ(load_bytes("a.glb", glb).error().code(), StatusCode::malformed_file);
  glb = skinned_strip().glb();
  overwrite_u32(glb, 12, 0xFFFFFFF0u);
  EXPECT_EQ(load_bytes("a.glb", glb).error().code(), StatusCode::malformed_file);

  GltfBuilder builder = skinned_strip();
  builder.json["buffers"] = {{{"byteLength", 4'000'000'000u}}};
  EXPECT_EQ(error_of(builder).code(), StatusCode::malformed_file);
  for (const Json& count :
       {Json(4'000'000'000u), Json(9.0e15), Json(-1), Json(1.5), Json("ten"), Json(0)}) {
    builder = skinned_strip();
    builder.json["accessors"][0]["count"] = count;
    EXPECT_FALSE(builder.load().has_value()) << count;
  }
  builder = skinned_strip();
  builder.json["accessors"][0] = {
      {"componentType", 5126}, {"count", 4'000'000'000u}, {"type", "VEC3"}};
  EXPECT_EQ(error_of(builder).code(), StatusCode::limit_exceeded);
}

TEST(LoadGltfBadInput, views_and_accessors_stay_inside_their_buffers) {
  GltfBuilder builder = skinned_strip();
  builder.json["accessors"][0]["bufferView"] = 99;
  Status error = error_of(builder);
  EXPECT_EQ(error.code(), StatusCode::index_out_of_range);
  EXPECT_EQ(error.text(), "/accessors/0/bufferView: buffer view 99 does not exist; the file has 7");
  builder = skinned_strip();
  builder.json["bufferViews"][2]["byteLength"] = 1'000'000;
  EXPECT_EQ(error_of(builder).code(), StatusCode::index_out_of_range);
  builder = skinned_strip();
  builder.json["accessors"][0]["byteOffset"] = 9'007'199'254'740'991;
  EXPECT_EQ(error_of(builder).code(), StatusCode::index_out_of_range);
  builder = skinned_strip();
  builder.json["bufferViews"][0]["byteStride"] = 9'007'199'254'740'991;
  EXPECT_EQ(error_of(builder).code(), StatusCode::index_out_of_range);
  builder = skinned_strip();
  builder.json["accessors"][0]["componentType"] = 5124;
  EXPECT_EQ(error_of(builder).code(), StatusCode::malformed_file);
  builder = skinned_strip();
  builder.json["accessors"][0]["type"] = "VEC5";
  EXPECT_EQ(error_of(builder).code(), StatusCode::malformed_file);
}

TEST(LoadGltfBadInput, indices_of_every_kind_are_checked) {
  const auto code_with = [](const char* pointer, const Json& value) {
    GltfBuilder builder = skinned_strip();
    builder.json[Json::json_pointer(pointer)] = value;
    return error_of(builder).code();
  };
  for (const char* const pointer :
       {"/scene", "/scenes/0/nodes/0", "/nodes/0/mesh", "/nodes/0/skin", "/nodes/1/children/0",
        "/skins/0/joints/0", "/skins/0/inverseBindMatrices", "/meshes/0/primitives/0/indices",
        "/meshes/0/primitives/0/material", "/meshes/0/primitives/0/attributes/POSITION",
        "/meshes/0/primitives/0/attributes/NORMAL", "/bufferViews/0/buffer"})
    EXPECT_EQ(code_with(pointer, 99), StatusCode::index_out_of_range) << pointer;
  EXPECT_EQ(code_with("/nodes/1/children/0", "x"), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/meshes/0/primitives", Json::object()), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/meshes", 3), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/nodes/0", nullptr), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/nodes/2/translation/0", 1e300), StatusCode::non_finite_value);
  EXPECT_EQ(code_with("/skins/0/joints", Json::array()), StatusCode::malformed_file);
  EXPECT_EQ(code_with("/meshes/0/primitives/0/mode", 7), StatusCode::malformed_file);
}

TEST(LoadGltfBadInput, extensions_that_hide_the_geometry_are_named) {
  GltfBuilder builder = skinned_strip();
  builder.json["extensionsRequired"] = {"KHR_texture_transform", "EXT_hidden_geometry"};
  const Status error = error_of(builder);
  EXPECT_EQ(error.code(), StatusCode::unsupported_feature);
  EXPECT_EQ(error.text(),
            "/extensionsRequired/1: the required extension EXT_hidden_geometry is not supported");
}

TEST(LoadGltfBadInput, deep_json_and_huge_objects_are_refused) {
  EXPECT_EQ(load_text("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(1'000'000, '['))
                .error()
                .code(),
            StatusCode::limit_exceeded);
  std::string wide = "{\"asset\":{\"version\":\"2.0\"},\"extras\":{";
  for (int i = 0; i < 200'000; ++i) wide += "\"k" + std::to_string(i) + "\":0,";
  EXPECT_EQ(load_text(wide + "\"last\":0}}").error().code(), StatusCode::limit_exceeded);
}

TEST(LoadGltfBadInput, a_small_file_that_unfolds_to_a_large_one_meets_the_limit) {
  GltfBuilder builder = skinned_strip();
  for (int i = 0; i < 2000; ++i) {
    builder.json["scenes"][0]["nodes"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"mesh", 0}});
  }
  LoadOptions options;
  options.maximum_bytes = 200'000;
  EXPECT_EQ(builder.load(options).error().code(), StatusCode::limit_exceeded);
  options.maximum_bytes = 100;
  EXPECT_EQ(skinned_strip().load(options).error().code(), StatusCode::limit_exceeded);
}

TEST(LoadGltfBadInput, a_data_uri_that_is_not_base64_is_refused) {
  EXPECT_EQ(
      load_text(skinned_strip().text_with_uri("data:application/octet-stream;base64,AA!!AA=="))
          .error()
          .code(),
      StatusCode::malformed_file);
  EXPECT_EQ(load_text(skinned_strip().text_with_uri("data:text/plain,hello")).error().code(),
            StatusCode::malformed_file);
  EXPECT_EQ(load_text(skinned_strip().text_with_uri("data:application/octet-stream;base64,AAAA"))
                .error()
                .code(),
            StatusCode::malformed_file);
}

void expect_refused_or_valid(const Result<LoadedCharacter>& loaded) {
  if (!loaded) {
    EXPECT_FALSE(loaded.error().text().empty());
    EXPECT_NE(loaded.error().code(), StatusCode::internal_error) << loaded.error().text();
    return;
  }
  const Status status = validate_character(*loaded->character);
  EXPECT_TRUE(status.is_ok()) << status.text();
}

TEST(LoadGltfBadInput, random_damage_never_breaks_more_than_the_file) {
  GltfBuilder builder = skinned_strip();
  const std::size_t times = builder.add(std::vector<float>{0, 1}, "SCALAR"),
                    values = builder.add(std::vector<float>(6), "VEC3");
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "scale"}}}}}},
       {"samplers", {{{"input", times}, {"output", values}}}}}};
  builder.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0.25, -2, 0, 5, 6, 7, 1};
  const auto original = builder.glb();
  std::mt19937 random(20240611);
  LoadOptions options;
  options.maximum_bytes = 1 << 20;
  const TemporaryFolder folder;
  const std::string_view interesting = "0123456789-.eE\"{}[],:tn";
  for (int round = 0; round < 1500; ++round) {
    auto damaged = original;
    for (unsigned hits = 1 + random() % 4; hits > 0; --hits) {
      std::byte& at = damaged[random() % damaged.size()];
      at = random() % 2 == 0 ? static_cast<std::byte>(random() % 256)
                             : static_cast<std::byte>(interesting[random() % interesting.size()]);
    }
    SCOPED_TRACE(round);
    expect_refused_or_valid(load_character(folder.write("damaged.glb", damaged), options));
  }
}

TEST(LoadGltfBadInput, shared_bad_models_are_refused_or_repaired) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const auto bad = shared_models() / "bad";
  const auto code_of = [&](const char* name, const LoadOptions& options = {}) {
    return load_character(bad / name, options).error().code();
  };
  EXPECT_EQ(code_of("accessor_oob.gltf"), StatusCode::index_out_of_range);
  EXPECT_EQ(code_of("nan_position.gltf"), StatusCode::non_finite_value);
  EXPECT_EQ(code_of("node_cycle.gltf"), StatusCode::not_a_tree);
  EXPECT_EQ(code_of("truncated_fox.glb"), StatusCode::malformed_file);
  EXPECT_EQ(code_of("joint_oob.gltf"), StatusCode::ok);
  EXPECT_EQ(code_of("joint_oob.gltf", strict()), StatusCode::index_out_of_range);
  EXPECT_EQ(code_of("weights_zero.gltf"), StatusCode::ok);
  EXPECT_EQ(code_of("weights_zero.gltf", strict()), StatusCode::weights_not_normalized);
}

TEST(LoadGltfModels, rigged_models_load) {
  auto files = rigged_gltf_models();
  if (!shared_models().empty())
    for (const auto& file : files_below(shared_models() / "static", {".glb", ".gltf"}))
      files.push_back(file);
  ASSERT_GE(files.size(), 8u);
  for (const auto& file : files) {
    const auto loaded = load_character(file, strict());
    ASSERT_TRUE(loaded.has_value()) << file << ": " << loaded.error().text();
    expect_refused_or_valid(loaded);
  }
}

TEST(LoadGltfModels, quantised_weights_equal_the_floats_they_were_made_from) {
  const auto bytes = load_character(own_data() / "rigged" / "tube_weights_u8.glb");
  const auto floats = load_character(own_data() / "rigged" / "tube.glb");
  ASSERT_TRUE(bytes.has_value() && floats.has_value());
  const auto& a = bytes->character->meshes[0].weights;
  const auto& b = floats->character->meshes[0].weights;
  ASSERT_FALSE(a.influences.empty());
  ASSERT_EQ(a.influences.size(), b.influences.size());
  for (std::size_t i = 0; i < a.influences.size(); ++i)
    EXPECT_NEAR(a.influences[i].weight, b.influences[i].weight, 1.0f / 255.0f);
}

TEST(LoadGltfModels, assimps_test_models_are_refused_or_valid) {
  if (assimp_models().empty()) GTEST_SKIP() << "needs Debian's package assimp-testmodels";
  const auto files = files_below(assimp_models(), {".glb", ".gltf"});
  std::size_t loaded_count = 0;
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const auto loaded = load_character(file);
    expect_refused_or_valid(loaded);
    loaded_count += loaded.has_value();
  }
  EXPECT_GE(loaded_count, 25u);
}

}  // namespace
}  // namespace sunder::test
