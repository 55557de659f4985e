// load_character() and save_glb() on what glTF files of other programs use: sparse accessors,
// several scenes, skins and instances, inexact matrices, and extensions.

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "support/oracles/glb_contents.h"

namespace sunder::test {
namespace {

struct SavedWorld {
  Json json;
  Result<LoadedCharacter> again = Status();
  std::vector<std::byte> bytes;
};

/// Retires a triangle of a mesh, and saves.
SavedWorld torn_and_saved(const LoadedCharacter& loaded, std::size_t mesh = 0) {
  Character torn = *loaded.character;
  torn.meshes[mesh].triangles[0].fill(0);
  const TemporaryFolder folder;
  const auto file = folder.path() / "torn.glb";
  const Status status = save_glb(file, torn, loaded);
  EXPECT_TRUE(status) << status.text();
  if (has_gltf_validator()) {
    const ValidatorReport report = validate_glb(file);
    EXPECT_EQ(report.errors, 0) << report.output;
  }
  const std::vector<std::byte> bytes = read_bytes(file);
  return {GltfBuilder::from_glb(bytes).json, load_character(file), bytes};
}

LoadedCharacter loaded_from(const GltfBuilder& builder, const LoadOptions& options = {}) {
  auto loaded = builder.load(options);
  EXPECT_TRUE(loaded.has_value()) << loaded.error().text();
  return *loaded;
}

template <class T>
Json sparse_of(GltfBuilder& builder, const std::vector<std::uint16_t>& indices,
               const std::vector<T>& values) {
  const std::size_t index_view = builder.add_view(indices), value_view = builder.add_view(values);
  return {{"count", indices.size()},
          {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
          {"values", {{"bufferView", value_view}}}};
}

TEST(GltfOfTheWorld, joints_and_weights_may_be_sparse_without_a_base) {
  GltfBuilder builder = skinned_strip();
  std::vector<std::uint16_t> all(kStripVertices);
  std::vector<float> weights;
  for (std::uint16_t v = 0; v < kStripVertices; ++v) {
    all[v] = v;
    weights.insert(weights.end(), {1, 0, 0, 0});
  }
  const Json sparse_weights = sparse_of(builder, all, weights),
             sparse_joints =
                 sparse_of(builder, {2, 7}, std::vector<std::uint8_t>{1, 0, 0, 0, 1, 0, 0, 0});
  Json& accessors = builder.json["accessors"];
  strip_attributes(builder)["WEIGHTS_0"] = accessors.size();
  accessors.push_back({{"componentType", 5126},
                       {"count", kStripVertices},
                       {"type", "VEC4"},
                       {"sparse", sparse_weights}});
  strip_attributes(builder)["JOINTS_0"] = accessors.size();
  accessors.push_back({{"componentType", 5121},
                       {"count", kStripVertices},
                       {"type", "VEC4"},
                       {"sparse", sparse_joints}});
  const LoadedCharacter loaded = loaded_from(builder, strict());
  const SkinWeights& read = loaded.character->meshes.at(0).weights;
  for (std::uint32_t v = 0; v < kStripVertices; ++v) {
    ASSERT_EQ(read.of(v).size(), 1u);
    EXPECT_EQ(read.of(v)[0].slot, v == 2 || v == 7 ? 1u : 0u);
  }
  const SavedWorld saved = torn_and_saved(loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(saved.again->character->meshes.at(0).weights, read);
}

TEST(GltfOfTheWorld, key_frames_and_morph_targets_may_be_sparse) {
  GltfBuilder builder = skinned_strip();
  const Json some = sparse_of(builder, {1}, std::vector<float>{0, 3, 0});
  Json& accessors = builder.json["accessors"];
  const auto add = [&](std::size_t count) {
    accessors.push_back(
        {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}, {"sparse", some}});
    accessors.back()["min"] = {0, 0, 0};
    accessors.back()["max"] = {0, 3, 0};
    return accessors.size() - 1;
  };
  const std::size_t times = builder.add(std::vector<float>{0, 1}, "SCALAR");
  accessors[times]["min"] = {0};
  accessors[times]["max"] = {1};
  const std::size_t deltas = add(kStripVertices), keys = add(2);
  builder.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"POSITION", deltas}}});
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", keys}}}}}};
  const LoadedCharacter loaded = loaded_from(builder, strict());
  EXPECT_EQ(loaded.character->meshes.at(0).morph_targets.at(0).position_deltas[1], Vec3f(0, 3, 0));
  EXPECT_EQ(loaded.character->clips.at(0).channels.at(0).values,
            (std::vector<float>{0, 0, 0, 0, 3, 0}));
  const SavedWorld saved = torn_and_saved(loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(saved.again->character->clips, loaded.character->clips);
  EXPECT_EQ(saved.again->character->meshes.at(0).morph_targets,
            loaded.character->meshes.at(0).morph_targets);
}

/// A second scene, whose node uses the mesh of the first one, and a mesh of its own.
GltfBuilder two_scenes() {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  builder.json["nodes"].push_back({{"name", "elsewhere"}, {"mesh", 0}});
  builder.json["nodes"].push_back({{"name", "own"}, {"mesh", 1}});
  builder.json["scenes"].push_back({{"name", "second"}, {"nodes", {3, 4}}});
  return builder;
}

TEST(GltfOfTheWorld, the_default_scene_is_loaded_and_the_others_are_reported) {
  GltfBuilder builder = two_scenes();
  const LoadedCharacter first = loaded_from(builder);
  EXPECT_EQ(first.character->meshes.size(), 1u);
  EXPECT_TRUE(has_note(first.report, LoadNote::Kind::information, "default scene"));
  builder.json["scene"] = 1;
  const LoadedCharacter second = loaded_from(builder);
  EXPECT_EQ(second.character->meshes.size(), 2u);
  EXPECT_EQ(second.character->name, "second");
  EXPECT_FALSE(
      has_note(loaded_from(skinned_strip()).report, LoadNote::Kind::information, "default scene"));
}

TEST(GltfOfTheWorld, a_tear_leaves_other_scenes_as_they_were) {
  const GltfBuilder builder = two_scenes();
  const SavedWorld saved = torn_and_saved(loaded_from(builder));
  EXPECT_EQ(saved.json["scenes"], builder.json["scenes"]);
  EXPECT_EQ(saved.json["nodes"][3], builder.json["nodes"][3]);
  EXPECT_EQ(saved.json["meshes"][0], builder.json["meshes"][0]);
  EXPECT_NE(saved.json["nodes"][0]["mesh"], 0) << "the torn mesh is a copy";
}

/// Three nodes with the strip: two with its skin, one with another skin on the same joints.
GltfBuilder three_instances() {
  GltfBuilder builder = skinned_strip();
  std::vector<float> binds(32, 0.0f);
  for (std::size_t matrix = 0; matrix < 2; ++matrix)
    for (std::size_t k = 0; k < 4; ++k) binds[matrix * 16 + k * 5] = 1.0f;
  binds[13] = -2.0f;
  binds[29] = -3.0f;
  const std::size_t accessor = builder.add(binds, "MAT4");
  builder.json["skins"].push_back({{"joints", {1, 2}}, {"inverseBindMatrices", accessor}});
  builder.json["nodes"].push_back({{"name", "twin"}, {"mesh", 0}, {"skin", 0}});
  builder.json["nodes"].push_back({{"name", "other"}, {"mesh", 0}, {"skin", 1}});
  builder.json["scenes"][0]["nodes"] = {0, 1, 3, 4};
  return builder;
}

TEST(GltfOfTheWorld, instances_of_one_mesh_are_meshes_with_their_own_skins) {
  const LoadedCharacter loaded = loaded_from(three_instances(), strict());
  const Character& character = *loaded.character;
  ASSERT_EQ(character.meshes.size(), 3u);
  EXPECT_EQ(character.meshes[0].skin, character.meshes[1].skin);
  EXPECT_NE(character.meshes[0].skin, character.meshes[2].skin);
  EXPECT_EQ(character.meshes[0].positions, character.meshes[2].positions);
  EXPECT_EQ(character.skins[character.meshes[2].skin].bone_from_bind[0].translation().y(), -2.0f);
}

TEST(GltfOfTheWorld, each_instance_is_torn_alone_and_keeps_its_skin) {
  const GltfBuilder builder = three_instances();
  const LoadedCharacter loaded = loaded_from(builder);
  for (std::size_t torn = 0; torn < 3; ++torn) {
    const SavedWorld saved = torn_and_saved(loaded, torn);
    ASSERT_TRUE(saved.again.has_value());
    ASSERT_EQ(saved.again->character->meshes.size(), 3u);
    for (std::size_t mesh = 0; mesh < 3; ++mesh)
      EXPECT_EQ(saved.again->character->meshes[mesh].triangle_count(), mesh == torn ? 7u : 8u);
    EXPECT_EQ(saved.again->character->skins, loaded.character->skins);
    for (const std::size_t node : {0u, 3u, 4u})
      EXPECT_EQ(saved.json["nodes"][node]["skin"], builder.json["nodes"][node]["skin"]);
  }
}

TEST(GltfOfTheWorld, primitives_of_one_mesh_share_the_skins_of_its_nodes) {
  GltfBuilder builder = three_instances();
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["attributes"]["POSITION"] =
      builder.add(std::vector<float>(3 * kStripVertices, 0.5f), "VEC3");
  builder.json["accessors"].back()["min"] = {0.5, 0.5, 0.5};
  builder.json["accessors"].back()["max"] = {0.5, 0.5, 0.5};
  const LoadedCharacter loaded = loaded_from(builder, strict());
  ASSERT_EQ(loaded.character->meshes.size(), 6u);
  for (std::size_t node = 0; node < 3; ++node)
    EXPECT_EQ(loaded.character->meshes[2 * node].skin, loaded.character->meshes[2 * node + 1].skin);
  const SavedWorld saved = torn_and_saved(loaded, 4);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(saved.again->character->meshes[4].triangle_count(), 7u);
  EXPECT_EQ(saved.again->character->meshes[5].triangle_count(), 8u);
  EXPECT_EQ(saved.again->character->skins, loaded.character->skins);
}

TEST(GltfOfTheWorld, copies_by_the_gpu_are_reported) {
  GltfBuilder builder = skinned_strip();
  const std::size_t places = builder.add(std::vector<float>{0, 0, 0, 5, 0, 0}, "VEC3");
  builder.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
      places;
  const LoadedCharacter loaded = loaded_from(builder);
  EXPECT_TRUE(has_note(loaded.report, LoadNote::Kind::dropped, "EXT_mesh_gpu_instancing"));
  EXPECT_EQ(loaded.character->meshes.size(), 1u);
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::unsupported_feature);
  const GlbContents saved(torn_and_saved(loaded).bytes);
  const Json attributes =
      saved.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  EXPECT_EQ(attributes.size(), 1u);
  EXPECT_EQ(saved.numbers(attributes["TRANSLATION"].get<std::size_t>()),
            (std::vector<double>{0, 0, 0, 5, 0, 0}));
}

TEST(GltfOfTheWorld, texture_transforms_stay) {
  GltfBuilder builder = skinned_strip();
  const std::string png("\x89PNG\r\n\x1A\n no pixels", 18);
  builder.json["images"] = {
      {{"mimeType", "image/png"},
       {"bufferView", builder.add_view(std::vector<char>(png.begin(), png.end()))}}};
  builder.json["textures"] = {{{"source", 0}}};
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", 0},
      {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"rotation", 0.5}}}}}};
  for (const char* const list : {"extensionsUsed", "extensionsRequired"})
    builder.json[list] = {"KHR_texture_transform"};
  const LoadedCharacter loaded = loaded_from(builder, strict());
  Character torn = *loaded.character;
  torn.meshes[0].triangles[0].fill(0);
  const TemporaryFolder folder;
  ASSERT_TRUE(save_glb(folder.path() / "torn.glb", torn, loaded));
  const Json json = GltfBuilder::from_glb(read_bytes(folder.path() / "torn.glb")).json;
  EXPECT_EQ(json["materials"], builder.json["materials"]);
  EXPECT_EQ(json["extensionsRequired"], builder.json["extensionsRequired"]);
}

/// The strip, with this in the last row of its second inverse bind matrix.
GltfBuilder with_last_row(const std::vector<float>& row) {
  GltfBuilder builder = skinned_strip();
  std::vector<float> binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  for (std::size_t i = 0; i < 4; ++i) binds[16 + 4 * i + 3] = row[i];
  builder.json["skins"][0]["inverseBindMatrices"] = builder.add(binds, "MAT4");
  return builder;
}

TEST(GltfOfTheWorld, inverse_binds_off_by_rounding_are_read_reported_and_written_exactly) {
  const Character exact = *loaded_from(skinned_strip()).character;
  for (const std::vector<float>& row :
       {std::vector<float>{0, 1e-5f, 0, 1}, {3e-4f, 0, -3e-4f, 0.9995f}}) {
    const GltfBuilder builder = with_last_row(row);
    const LoadedCharacter loaded = loaded_from(builder);
    EXPECT_EQ(*loaded.character, exact);
    EXPECT_TRUE(has_note(loaded.report, LoadNote::Kind::repaired, "last row"));
    EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::malformed_file);
    const SavedWorld saved = torn_and_saved(loaded);
    ASSERT_TRUE(saved.again.has_value());
    EXPECT_EQ(saved.again->character->skins, exact.skins);
    EXPECT_FALSE(has_note(saved.again->report, LoadNote::Kind::repaired, "last row"));
  }
  EXPECT_TRUE(with_last_row({0, 5e-7f, 0, 1}).load(strict())) << "float rounding of exact matrices";
  for (const std::vector<float>& row :
       {std::vector<float>{0, 0.01f, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 2}})
    EXPECT_EQ(with_last_row(row).load().error().code(), StatusCode::malformed_file);
}

TEST(GltfOfTheWorld, extensions_that_do_not_change_geometry_may_be_required) {
  const auto code_with = [](const std::string& extension) {
    GltfBuilder builder = skinned_strip();
    builder.json["extensionsUsed"] = {extension};
    builder.json["extensionsRequired"] = {extension};
    return builder.load().error().code();
  };
  for (const char* const harmless :
       {"KHR_mesh_quantization", "KHR_texture_basisu", "KHR_texture_transform", "EXT_texture_webp",
        "EXT_texture_avif", "MSFT_texture_dds", "KHR_materials_unlit", "KHR_materials_variants",
        "KHR_materials_pbrSpecularGlossiness", "KHR_lights_punctual", "KHR_xmp_json_ld",
        "EXT_mesh_features", "EXT_structural_metadata", "KHR_draco_mesh_compression",
        "EXT_meshopt_compression", "KHR_meshopt_compression"})
    EXPECT_EQ(code_with(harmless), StatusCode::ok) << harmless;
  for (const char* const unknown :
       {"EXT_mesh_gpu_instancing", "KHR_animation_pointer", "KHR_gaussian_splatting",
        "VENDOR_subdivision", "KHR_mesh_quantization2", "NV_micromesh"})
    EXPECT_EQ(code_with(unknown), StatusCode::unsupported_feature) << unknown;
}

}  // namespace
}  // namespace sunder::test
