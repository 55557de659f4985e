// Contract of save_glb(): include/sunder/io/character_file.h.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/fake_tear.h"
#include "support/models/gltf_builder.h"
#include "support/models/shared_models.h"
#include "support/oracles/glb_contents.h"

namespace sunder::test {
namespace {

struct Saved {
  Status status;
  std::vector<std::byte> bytes;
  Result<LoadedCharacter> again = Status();
};

Saved save(const Character& character, const LoadedCharacter& loaded,
           const SaveOptions& options = {}) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "torn.glb";
  Saved saved;
  saved.status = save_glb(file, character, loaded, options);
  EXPECT_TRUE(saved.status) << saved.status.text();
  saved.bytes = read_bytes(file);
  saved.again = load_character(file);
  EXPECT_TRUE(saved.again.has_value()) << saved.again.error().text();
  if (has_gltf_validator()) {
    const ValidatorReport report = validate_glb(file);
    EXPECT_EQ(report.errors, 0) << report.output;
  }
  return saved;
}

/// Triangles are written submesh by submesh.
Mesh grouped_by_submesh(Mesh mesh) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) {
    return mesh.triangle_submesh[a] < mesh.triangle_submesh[b];
  });
  const auto triangles = mesh.triangles;
  const auto submesh = mesh.triangle_submesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    mesh.triangles[i] = triangles[order[i]];
    mesh.triangle_submesh[i] = submesh[order[i]];
  }
  return mesh;
}

void expect_same_content(const Mesh& saved, const Mesh& expected) {
  EXPECT_EQ(saved.positions, expected.positions);
  EXPECT_EQ(saved.normals, expected.normals);
  EXPECT_EQ(saved.tangents, expected.tangents);
  EXPECT_EQ(saved.uv_sets, expected.uv_sets);
  EXPECT_EQ(saved.color_sets, expected.color_sets);
  EXPECT_EQ(saved.custom_attributes, expected.custom_attributes);
  EXPECT_EQ(saved.weights, expected.weights);
  EXPECT_EQ(saved.morph_targets, expected.morph_targets);
  EXPECT_EQ(saved.triangles, expected.triangles);
  EXPECT_EQ(saved.triangle_submesh, expected.triangle_submesh);
  EXPECT_EQ(saved.submeshes, expected.submeshes);
}

Json json_of(const std::vector<std::byte>& glb) {
  const auto* const text = reinterpret_cast<const char*>(glb.data());
  std::uint32_t length = 0;
  std::memcpy(&length, text + 12, 4);
  return Json::parse(text + 20, text + 20 + length);
}

LoadedCharacter loaded_strip(const GltfBuilder& builder = skinned_strip()) {
  auto loaded = builder.load();
  EXPECT_TRUE(loaded.has_value()) << loaded.error().text();
  return *loaded;
}

TEST(SaveGlb, an_unchanged_glb_is_copied_byte_for_byte) {
  const GltfBuilder builder = skinned_strip();
  const LoadedCharacter loaded = loaded_strip(builder);
  EXPECT_EQ(save(*loaded.character, loaded).bytes, builder.glb());
  const Character copy = *loaded.character;
  EXPECT_EQ(save(copy, loaded).bytes, builder.glb());
}

TEST(SaveGlb, an_unchanged_text_becomes_a_glb_of_the_same_content) {
  auto loaded = load_text(skinned_strip().text());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Saved saved = save(*loaded->character, *loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(*saved.again->character, *loaded->character);
  EXPECT_EQ(json_of(saved.bytes)["accessors"], skinned_strip().json["accessors"]);
}

TEST(SaveGlb, a_torn_mesh_comes_back_bit_for_bit) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)["COLOR_0"] =
      builder.add(std::vector<float>(kStripVertices * 3, 0.25f), "VEC3");
  strip_attributes(builder)["_HEAT"] =
      builder.add(std::vector<float>(kStripVertices * 2, 0.5f), "VEC2");
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  expect_same_content(saved.again->character->meshes[0], torn.meshes[0]);
  EXPECT_EQ(saved.again->character->skeleton, torn.skeleton);
  EXPECT_EQ(saved.again->character->skins, torn.skins);
  const Json json = json_of(saved.bytes);
  const Json& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(json["accessors"][primitive["attributes"]["COLOR_0"].get<std::size_t>()]["type"],
            "VEC3");
  EXPECT_TRUE(primitive["attributes"].contains("_TEARSIDE"));
}

TEST(SaveGlb, tear_sides_are_written_under_two_names_and_read_under_one) {
  const LoadedCharacter loaded = loaded_strip();
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  const Json json = json_of(saved.bytes);
  const Json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_EQ(attributes[kTearSideFeatureAttribute],
            attributes[kTearSideAttribute]);  // It takes no space.
  EXPECT_EQ(json["accessors"][attributes[kTearSideAttribute].get<std::size_t>()]["componentType"],
            5126);
  EXPECT_EQ(saved.again->character->meshes[0].custom_attributes, torn.meshes[0].custom_attributes);
  const Saved twice = save(torn, *saved.again);  // Neither name is added twice.
  EXPECT_EQ(json_of(twice.bytes)["meshes"][0]["primitives"][0]["attributes"].size(),
            attributes.size());
}

TEST(SaveGlb, labels_stay_labels) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)["_FEATURE_ID_0"] =
      builder.add(std::vector<std::uint16_t>(kStripVertices * 2, 300), "VEC2");
  builder.json["accessors"].back()["type"] = "VEC2";
  const LoadedCharacter loaded = loaded_strip(builder);
  ASSERT_FALSE(loaded.character->meshes[0].custom_attributes[0].interpolates);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  expect_same_content(saved.again->character->meshes[0], torn.meshes[0]);
}

TEST(SaveGlb, everything_else_of_the_document_stays) {
  GltfBuilder builder = skinned_strip();
  builder.json["extras"] = {{"studio", "x"}};
  builder.json["skins"][0]["extras"] = {{"kept", 1}};
  builder.json["meshes"][0]["primitives"][0]["extras"] = {{"kept", 2}};
  builder.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.01}}}}};
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const GlbContents source(builder.glb()), saved(save(torn, loaded).bytes);
  Json json = saved.json;
  // Accessors are renumbered, because those of the torn mesh are left out.
  Json skin = json["skins"][0], source_skin = builder.json["skins"][0];
  EXPECT_EQ(saved.numbers(skin["inverseBindMatrices"].get<std::size_t>()),
            source.numbers(source_skin["inverseBindMatrices"].get<std::size_t>()));
  for (Json* const one : {&skin, &source_skin}) one->erase("inverseBindMatrices");
  EXPECT_EQ(skin, source_skin);
  for (const char* const key : {"asset", "extras", "nodes", "scenes", "cameras", "materials"})
    EXPECT_EQ(json[key], builder.json[key]) << key;
  Json primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["extras"], (Json{{"kept", 2}}));
  EXPECT_EQ(primitive["material"], 0);
}

TEST(SaveGlb, a_submesh_without_triangles_disappears) {
  GltfBuilder builder = skinned_strip();
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  const LoadedCharacter loaded = loaded_strip(builder);
  ASSERT_EQ(loaded.character->meshes.size(), 1u);
  ASSERT_EQ(loaded.character->meshes[0].submeshes.size(), 2u);
  Character torn = *loaded.character;
  std::fill(torn.meshes[0].triangle_submesh.begin(), torn.meshes[0].triangle_submesh.end(), 1u);
  const Json json = json_of(save(torn, loaded).bytes);
  ASSERT_EQ(json["meshes"][0]["primitives"].size(), 1u);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["material"], 1);
}

TEST(SaveGlb, a_node_without_its_mesh_keeps_no_trace_of_it) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"].push_back({{"name", "other"}, {"mesh", 1}, {"weights", {0.5}}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  Json& primitive = builder.json["meshes"][1]["primitives"][0];
  primitive["targets"] = Json::array({{{"POSITION", primitive["attributes"]["POSITION"]}}});
  primitive["attributes"].erase("JOINTS_0");
  primitive["attributes"].erase("WEIGHTS_0");
  const std::size_t times = builder.add(std::vector<float>{0, 1}, "SCALAR"),
                    values = builder.add(std::vector<float>{0, 1}, "SCALAR");
  builder.json["accessors"][times]["min"] = {0};
  builder.json["accessors"][times]["max"] = {1};
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 3}, {"path", "weights"}}}}}},
       {"samplers", {{{"input", times}, {"output", values}}}}}};
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  ASSERT_EQ(torn.meshes.size(), 2u);
  torn.meshes[1].triangles.clear();
  torn.meshes[1].triangle_submesh.clear();
  const Json json = json_of(save(torn, loaded).bytes);
  EXPECT_FALSE(json["nodes"][3].contains("mesh"));
  EXPECT_FALSE(json["nodes"][3].contains("weights"));
  EXPECT_FALSE(json.contains("animations"));
}

TEST(SaveGlb, retired_triangles_are_not_written) {
  const LoadedCharacter loaded = loaded_strip();
  Character torn = *loaded.character;
  Mesh expected = torn.meshes[0];
  for (const std::uint32_t triangle : {0u, 3u, 7u}) retire(torn.meshes[0], triangle);
  for (const std::uint32_t triangle : {7u, 3u, 0u}) {
    expected.triangles.erase(expected.triangles.begin() + triangle);
    expected.triangle_submesh.pop_back();
  }
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  expect_same_content(saved.again->character->meshes[0], expected);
}

TEST(SaveGlb, a_primitive_whose_triangles_are_all_retired_disappears) {
  GltfBuilder builder = skinned_strip();
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  ASSERT_EQ(torn.meshes[0].submeshes.size(), 2u);
  for (std::uint32_t t = 0; t < torn.meshes[0].triangle_count(); ++t)
    if (torn.meshes[0].triangle_submesh[t] == 0) retire(torn.meshes[0], t);
  const Json json = json_of(save(torn, loaded).bytes);
  ASSERT_EQ(json["meshes"][0]["primitives"].size(), 1u);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["material"], 1);
}

TEST(SaveGlb, a_mesh_whose_triangles_are_all_retired_leaves_its_node) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  builder.json["nodes"].push_back({{"name", "twin"}, {"mesh", 1}, {"skin", 0}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  ASSERT_EQ(torn.meshes.size(), 2u);
  retire_all(torn.meshes[1]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(saved.again->character->meshes.size(), 1u);
  EXPECT_FALSE(json_of(saved.bytes)["nodes"][3].contains("mesh"));
  EXPECT_FALSE(json_of(saved.bytes)["nodes"][3].contains("skin"));
}

TEST(SaveGlb, a_model_without_any_triangle_left_is_a_valid_file) {
  const LoadedCharacter loaded = loaded_strip();
  Character torn = *loaded.character;
  retire_all(torn.meshes[0]);
  const TemporaryFolder folder;
  const auto patched = folder.path() / "patched.glb", anew = folder.path() / "anew.glb";
  ASSERT_TRUE(save_glb(patched, torn, loaded));
  ASSERT_TRUE(save_glb(anew, torn));
  for (const auto& file : {patched, anew}) {
    EXPECT_EQ(load_character(file).error().code(), StatusCode::empty_input) << file;
    if (!has_gltf_validator()) continue;
    const ValidatorReport report = validate_glb(file);
    EXPECT_EQ(report.errors, 0) << report.output;
  }
}

/// Closes an opening with two triangles that have their own vertices.
void add_cap(Mesh& mesh, const Submesh& submesh) {
  mesh.submeshes.push_back(submesh);
  for (const std::uint32_t t : {1u, 2u}) {
    Triangle triangle = mesh.triangles[t];
    std::swap(triangle[1], triangle[2]);
    for (std::uint32_t& vertex : triangle) vertex = append_copy(mesh, vertex);
    mesh.triangles.push_back(triangle);
    mesh.triangle_submesh.push_back(static_cast<std::uint32_t>(mesh.submeshes.size() - 1));
  }
}

TEST(SaveGlb, new_submeshes_become_primitives_of_the_same_vertices) {
  GltfBuilder builder = skinned_strip();
  std::vector<float> deltas(kStripVertices * 3, 0.125f);
  const std::size_t accessor = builder.add(deltas, "VEC3");
  builder.json["accessors"][accessor]["min"] = {0.125, 0.125, 0.125};
  builder.json["accessors"][accessor]["max"] = {0.125, 0.125, 0.125};
  builder.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"POSITION", accessor}}});
  builder.json["meshes"][0]["extras"]["targetNames"] = Json::array({"puff"});
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  add_cap(torn.meshes[0], {"cap", kNone});
  add_cap(torn.meshes[0], {"other", 1});
  add_cap(torn.meshes[0], {"wall", 0});
  add_cap(torn.meshes[0], {"", kNone});
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  ASSERT_EQ(saved.again->character->meshes.size(), 1u);
  expect_same_content(saved.again->character->meshes[0], torn.meshes[0]);
  const Json json = json_of(saved.bytes);
  const Json& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 5u);
  EXPECT_FALSE(primitives[1].contains("material"));
  EXPECT_EQ(primitives[1]["extras"], (Json{{"name", "cap"}}));
  EXPECT_EQ(primitives[2]["material"], 1);
  EXPECT_FALSE(primitives[2].contains("extras"));  // Its material has that name.
  EXPECT_EQ(primitives[3]["material"], 0);
  EXPECT_EQ(primitives[3]["extras"], (Json{{"name", "wall"}}));
  EXPECT_FALSE(primitives[4].contains("extras"));
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(primitives[i]["attributes"], primitives[0]["attributes"]);
    EXPECT_EQ(primitives[i]["targets"], primitives[0]["targets"]);
  }
}

TEST(SaveGlb, a_new_document_has_new_submeshes_and_no_retired_triangles) {
  Character torn = *loaded_strip().character;
  fake_tear(torn.meshes[0]);
  add_cap(torn.meshes[0], {"cap", kNone});
  retire(torn.meshes[0], 4);
  retire(torn.meshes[0], 8);
  retire(torn.meshes[0], 9);
  add_cap(torn.meshes[0], {"wall", kNone});  // "cap" has no triangle left.
  const TemporaryFolder folder;
  ASSERT_TRUE(save_glb(folder.path() / "new.glb", torn));
  const auto again = load_character(folder.path() / "new.glb");
  ASSERT_TRUE(again.has_value()) << again.error().text();
  const Mesh& mesh = again->character->meshes[0];
  EXPECT_EQ(mesh.triangle_count(), 7u + 2u);
  ASSERT_EQ(mesh.submeshes.size(), 2u);
  EXPECT_EQ(mesh.submeshes[1].name, "wall");
  EXPECT_EQ(mesh.custom_attributes, torn.meshes[0].custom_attributes);
  EXPECT_EQ(mesh.positions, torn.meshes[0].positions);
  if (!has_gltf_validator()) return;
  const ValidatorReport report = validate_glb(folder.path() / "new.glb");
  EXPECT_EQ(report.errors, 0) << report.output;
}

TEST(SaveGlb, refuses_a_material_that_the_source_does_not_have) {
  const LoadedCharacter loaded = loaded_strip();
  Character torn = *loaded.character;
  add_cap(torn.meshes[0], {"cap", 2});
  const TemporaryFolder folder;
  EXPECT_EQ(save_glb(folder.path() / "torn.glb", torn, loaded).code(),
            StatusCode::index_out_of_range);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SaveGlb, appends_materials_that_a_submesh_names_and_keeps_those_of_the_source) {
  const LoadedCharacter loaded = loaded_strip();
  const Json before = skinned_strip().json["materials"];
  SaveOptions options;
  options.materials = {{"Flesh", {0.5f, 0.125f, 0.0625f, 1.0f}, 0.0f, 0.25f, true}};
  const TemporaryFolder folder;
  const auto file = folder.path() / "torn.glb";
  ASSERT_TRUE(save_glb(file, *loaded.character, loaded, options));
  EXPECT_EQ(json_of(read_bytes(file))["materials"], before) << "nothing names it";

  Character torn = *loaded.character;
  add_cap(torn.meshes[0], {"Flesh", static_cast<Index>(before.size())});
  ASSERT_TRUE(save_glb(file, torn, loaded, options));
  Json materials = json_of(read_bytes(file))["materials"];
  ASSERT_EQ(materials.size(), before.size() + 1);
  EXPECT_EQ(materials.back(), Json({{"pbrMetallicRoughness",
                                     {{"baseColorFactor", {0.5, 0.125, 0.0625, 1.0}},
                                      {"metallicFactor", 0.0},
                                      {"roughnessFactor", 0.25}}},
                                    {"name", "Flesh"},
                                    {"doubleSided", true}}));
  materials.erase(materials.size() - 1);
  EXPECT_EQ(materials, before);
  const auto again = load_character(file);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->character->meshes[0].submeshes.back(), torn.meshes[0].submeshes.back());
  if (has_gltf_validator()) {
    EXPECT_EQ(validate_glb(file).errors, 0);
  }
}

TEST(SaveGlb, refuses_appended_materials_that_glTF_cannot_hold) {
  const LoadedCharacter loaded = loaded_strip();
  const TemporaryFolder folder;
  SaveOptions options;
  options.materials = {{}, {"Flesh", {0.5f, 1.5f, 0.0f, 1.0f}}};
  const Status status = save_glb(folder.path() / "torn.glb", *loaded.character, loaded, options);
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(status.index(), 1u);
  options.materials.pop_back();
  EXPECT_EQ(save_glb(folder.path() / "new.glb", *loaded.character, options).code(),
            StatusCode::invalid_argument)
      << "there is no source to append to";
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SaveGlb, an_instance_is_torn_alone) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"].push_back({{"name", "twin"}, {"mesh", 0}, {"skin", 0}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  const LoadedCharacter loaded = loaded_strip(builder);
  ASSERT_EQ(loaded.character->meshes.size(), 2u);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[1]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(json_of(saved.bytes)["meshes"].size(), 2u);
  expect_same_content(saved.again->character->meshes[0], loaded.character->meshes[0]);
  expect_same_content(saved.again->character->meshes[1], torn.meshes[1]);
}

TEST(SaveGlb, a_rigid_mesh_is_written_without_weights) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"][0].erase("skin");
  builder.json.erase("skins");
  strip_attributes(builder).erase("JOINTS_0");
  strip_attributes(builder).erase("WEIGHTS_0");
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_FALSE(
      json_of(saved.bytes)["meshes"][0]["primitives"][0]["attributes"].contains("JOINTS_0"));
  expect_same_content(saved.again->character->meshes[0], torn.meshes[0]);
}

TEST(SaveGlb, a_torn_strip_becomes_triangles) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"][0]["primitives"][0]["mode"] = 5;
  builder.json["meshes"][0]["primitives"][0]["indices"] =
      builder.add(std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5}, "SCALAR");
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0], 1);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(saved.again->character->meshes[0].triangles, torn.meshes[0].triangles);
}

TEST(SaveGlb, more_than_four_influences_take_more_sets_or_are_cut_to_the_largest) {
  GltfBuilder builder = skinned_strip();
  Json joints = Json::array();
  for (int i = 0; i < 6; ++i) {
    joints.push_back(builder.json["nodes"].size());
    builder.json["nodes"][1]["children"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"name", "bone" + std::to_string(i)}});
  }
  builder.json["skins"][0] = {{"joints", joints}};
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  const std::vector<Influence> six = {{0, 0.0625f}, {1, 0.125f},  {2, 0.25f},
                                      {3, 0.25f},   {4, 0.1875f}, {5, 0.125f}};
  torn.meshes[0].weights = {};
  for (std::size_t v = 0; v < kStripVertices; ++v) torn.meshes[0].weights.append(six);

  const Saved all = save(torn, loaded, {kAllInfluences});
  ASSERT_TRUE(all.again.has_value());
  EXPECT_EQ(all.again->character->meshes[0].weights, torn.meshes[0].weights);

  const Saved four = save(torn, loaded, {4});
  ASSERT_TRUE(four.again.has_value());
  // The source has at most two per vertex, so four are also the default.
  EXPECT_EQ(save(torn, loaded).bytes, four.bytes);
  const auto kept = four.again->character->meshes[0].weights.of(0);
  ASSERT_EQ(kept.size(), 4u);
  EXPECT_EQ(kept[0].slot, 2u);
  EXPECT_EQ(kept[1].slot, 3u);
  EXPECT_EQ(kept[2].slot, 4u);
  EXPECT_EQ(kept[3].slot, 1u);
  EXPECT_FLOAT_EQ(kept[0].weight, 0.25f / 0.8125f);

  EXPECT_EQ(save_glb("/nowhere/x.glb", torn, loaded, {5}).code(), StatusCode::invalid_argument);
}

TEST(SaveGlb, weights_that_loading_repaired_are_written_when_anything_is_torn) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  builder.json["nodes"].push_back({{"name", "bad"}, {"mesh", 1}, {"skin", 0}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  std::vector<float> unnormalised(kStripVertices * 4, 0.25f);
  unnormalised[5] = 0.0f;
  builder.json["meshes"][1]["primitives"][0]["attributes"]["WEIGHTS_0"] =
      builder.add(unnormalised, "VEC4");
  std::vector<std::uint8_t> joints(kStripVertices * 4, 0);
  for (std::size_t v = 0; v < kStripVertices; ++v) joints[v * 4 + 1] = 1;
  builder.json["meshes"][1]["primitives"][0]["attributes"]["JOINTS_0"] =
      builder.add(joints, "VEC4");
  const LoadedCharacter loaded = loaded_strip(builder);
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const Saved saved = save(torn, loaded);  // Also checks that the validator finds no error.
  ASSERT_TRUE(saved.again.has_value());
  EXPECT_EQ(saved.again->character->meshes[1].weights, torn.meshes[1].weights);
  for (const LoadNote& note : saved.again->report.notes)
    EXPECT_EQ(note.kind, LoadNote::Kind::information) << note.text;
}

TEST(SaveGlb, morph_targets_come_back) {
  GltfBuilder builder = skinned_strip();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  std::vector<float> deltas(kStripVertices * 3, 0.125f);
  const std::size_t accessor = builder.add(deltas, "VEC3");
  builder.json["accessors"][accessor]["min"] = {0.125, 0.125, 0.125};
  builder.json["accessors"][accessor]["max"] = {0.125, 0.125, 0.125};
  primitive["targets"] =
      Json::array({{{"POSITION", accessor}}, {{"POSITION", accessor}, {"NORMAL", accessor}}});
  builder.json["meshes"][0]["extras"]["targetNames"] = {"puff", "lean"};
  builder.json["meshes"][0]["weights"] = {0.5, 0.25};
  const LoadedCharacter loaded = loaded_strip(builder);
  EXPECT_EQ(loaded.character->rest_morph_weights, (std::vector<float>{0.5f, 0.25f}));
  Character torn = *loaded.character;
  fake_tear(torn.meshes[0]);
  const Saved saved = save(torn, loaded);
  ASSERT_TRUE(saved.again.has_value());
  expect_same_content(saved.again->character->meshes[0], torn.meshes[0]);
  EXPECT_EQ(saved.again->character->rest_morph_weights, torn.rest_morph_weights);
}

/// A target for each vertex that moves it by a different distance.
MorphTarget target_for(const Mesh& mesh, const std::string& name) {
  MorphTarget target{name, {}, {}, {}};
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    target.position_deltas.emplace_back(0.5f, 0.25f * static_cast<float>(v), 0.0f);
  return target;
}

TEST(SaveGlb, morph_targets_can_be_appended_to_all_meshes_of_a_node) {
  GltfBuilder builder = skinned_strip();
  builder.json["meshes"].push_back(builder.json["meshes"][0]);
  builder.json["nodes"].push_back({{"name", "other"}, {"mesh", 1}, {"skin", 0}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  std::vector<float> deltas(kStripVertices * 3, 0.125f);
  const std::size_t accessor = builder.add(deltas, "VEC3");
  builder.json["accessors"][accessor]["min"] = {0.125, 0.125, 0.125};
  builder.json["accessors"][accessor]["max"] = {0.125, 0.125, 0.125};
  builder.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"POSITION", accessor}}});
  builder.json["meshes"][0]["weights"] = {0.5};
  builder.json["meshes"][0]["extras"]["targetNames"] = {"puff"};
  const LoadedCharacter loaded = loaded_strip(builder);
  ASSERT_EQ(loaded.character->meshes.size(), 2u);

  Character more = *loaded.character;
  Mesh& mesh = more.meshes[0];
  mesh.morph_targets.push_back(target_for(mesh, "lean"));
  mesh.first_morph_weight = static_cast<std::uint32_t>(more.rest_morph_weights.size());
  more.rest_morph_weights.insert(more.rest_morph_weights.end(), {0.5f, 0.75f});
  const Saved saved = save(more, loaded);
  ASSERT_TRUE(saved.again.has_value());
  const Character& again = *saved.again->character;
  EXPECT_EQ(again.meshes[0].morph_targets, mesh.morph_targets);
  expect_same_content(again.meshes[1], loaded.character->meshes[1]);
  const std::uint32_t first = again.meshes[0].first_morph_weight;
  EXPECT_EQ(again.rest_morph_weights[first], 0.5f);
  EXPECT_EQ(again.rest_morph_weights[first + 1], 0.75f);

  // What the file cannot hold is refused: fewer targets, and weights that a clip drives in part.
  const TemporaryFolder folder;
  Character fewer = *loaded.character;
  fewer.meshes[0].morph_targets.clear();
  EXPECT_EQ(save_glb(folder.path() / "fewer.glb", fewer, loaded).code(),
            StatusCode::invalid_argument);
  Character in_part = more;
  Clip clip;
  clip.name = "part";
  clip.duration = 1;
  clip.channels.push_back(
      {ChannelTarget::morph_weights, first, 1, Interpolation::linear, {0.0f}, {0.0f}});
  in_part.clips.push_back(clip);
  EXPECT_EQ(save_glb(folder.path() / "part.glb", in_part, loaded).code(),
            StatusCode::invalid_argument);
}

/// A white pixel.
std::string one_pixel_png() {
  constexpr unsigned char kBytes[] = {
      0x89, 'P',  'N',  'G',  '\r', '\n', 0x1A, '\n', 0,    0,    0,    13,   'I',  'H',
      'D',  'R',  0,    0,    0,    1,    0,    0,    0,    1,    8,    0,    0,    0,
      0,    0x3A, 0x7E, 0x9B, 0x55, 0,    0,    0,    10,   'I',  'D',  'A',  'T',  0x78,
      0x9C, 0x63, 0xF8, 0x0F, 0x00, 0x01, 0x01, 0x01, 0x00, 0x1B, 0xB6, 0xEE, 0x56, 0,
      0,    0,    0,    'I',  'E',  'N',  'D',  0xAE, 0x42, 0x60, 0x82};
  return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};
}

TEST(SaveGlb, several_external_buffers_and_images_end_in_one_file) {
  GltfBuilder builder = skinned_strip();
  const TemporaryFolder folder;
  const auto& binary = builder.binary();
  folder.write("a.bin", binary);
  std::vector<std::byte> shifted(binary.size() + 6, std::byte{7});
  std::copy(binary.begin(), binary.end(), shifted.begin() + 6);
  folder.write("sub/b c.bin", shifted);
  const std::string png = one_pixel_png();
  folder.write("sub/skin.png", png);
  builder.json["buffers"] = {{{"byteLength", binary.size()}, {"uri", "a.bin"}},
                             {{"byteLength", shifted.size()}, {"uri", "sub/b%20c.bin"}}};
  Json& views = builder.json["bufferViews"];
  for (std::size_t i = 0; i < views.size(); i += 2) {
    views[i]["buffer"] = 1;
    views[i]["byteOffset"] = views[i]["byteOffset"].get<std::size_t>() + 6;
  }
  builder.json["images"] = {{{"uri", "sub/skin.png"}}, {{"uri", "missing.png"}}};
  auto loaded = load_character(folder.write("model.gltf", builder.json.dump()));
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  Character torn = *loaded->character;
  fake_tear(torn.meshes[0]);
  const auto file = folder.path() / "torn.glb";
  ASSERT_TRUE(save_glb(file, torn, *loaded));
  const auto again = load_character(file);
  ASSERT_TRUE(again.has_value()) << again.error().text();
  expect_same_content(again->character->meshes[0], torn.meshes[0]);
  const Json json = json_of(read_bytes(file));
  EXPECT_EQ(json["buffers"].size(), 1u);
  EXPECT_EQ(json["images"][0]["mimeType"], "image/png");
  EXPECT_EQ(json["bufferViews"][json["images"][0]["bufferView"].get<std::size_t>()]["byteLength"],
            png.size());
  EXPECT_EQ(json["images"][1]["uri"], "missing.png");
}

TEST(SaveGlb, a_failing_save_leaves_the_folder_as_it_was) {
  const LoadedCharacter loaded = loaded_strip();
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "taken.glb");
  EXPECT_EQ(save_glb(folder.path() / "taken.glb", *loaded.character, loaded).code(),
            StatusCode::file_unreadable);
  EXPECT_EQ(save_glb(folder.path() / "no" / "folder.glb", *loaded.character, loaded).code(),
            StatusCode::file_unreadable);
  Character other = *loaded.character;
  other.meshes.push_back(other.meshes[0]);
  EXPECT_EQ(save_glb(folder.path() / "other.glb", other, loaded).code(), StatusCode::size_mismatch);
  other = *loaded.character;
  other.skeleton.bones[0].name = "renamed";
  EXPECT_EQ(save_glb(folder.path() / "other.glb", other, loaded).code(),
            StatusCode::invalid_argument);
  other = *loaded.character;
  other.meshes[0].weights.influences[0].weight = 0.5f;
  EXPECT_EQ(save_glb(folder.path() / "other.glb", other, loaded).code(),
            StatusCode::weights_not_normalized);
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++entries;
  EXPECT_EQ(entries, 1u);
}

TEST(SaveGlb, rigged_models_come_back_torn) {
  ASSERT_GE(rigged_gltf_models().size(), 8u);
  for (const auto& file : rigged_gltf_models()) {
    SCOPED_TRACE(file.filename());
    const auto loaded = load_character(file);
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    Character torn = *loaded->character;
    for (Mesh& mesh : torn.meshes) fake_tear(mesh, 20);
    const Saved saved = save(torn, *loaded);
    ASSERT_TRUE(saved.again.has_value());
    ASSERT_EQ(saved.again->character->meshes.size(), torn.meshes.size());
    for (std::size_t i = 0; i < torn.meshes.size(); ++i)
      expect_same_content(saved.again->character->meshes[i], grouped_by_submesh(torn.meshes[i]));
    EXPECT_EQ(saved.again->character->clips, torn.clips);
    EXPECT_EQ(saved.again->character->skeleton, torn.skeleton);
  }
}

TEST(SaveGlb, the_validator_checks_the_files_written_above) {
  // The tests use the validator if it is installed; this one reports by name if it is not.
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
}

}  // namespace
}  // namespace sunder::test
