// What a torn file leaves out: data that nothing in it uses. All else is there and decodes to the
// same numbers, read by nothing but the rules of the format.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/stress.h"
#include "support/machine/temporary_folder.h"
#include "support/models/fake_tear.h"
#include "support/models/random_document.h"
#include "support/models/shared_models.h"
#include "support/oracles/glb_contents.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;

/// Data keeps its alignment, so up to three bytes stay in a gap; seven, if unknown extensions may
/// refer to whole views.
constexpr std::size_t kPadding = 3, kForeignPadding = 7;

enum class Edit { none, torn, emptied };

GlbContents saved(const fs::path& file, const Character& character, const LoadedCharacter& loaded) {
  const Status status = save_glb(file, character, loaded);
  EXPECT_TRUE(status) << status.text();
  return GlbContents(read_bytes(file));
}

GlbContents saved(const Character& character, const LoadedCharacter& loaded) {
  const TemporaryFolder folder;
  return saved(folder.path() / "torn.glb", character, loaded);
}

/// A value in which every number of an accessor is replaced by its content.
Json with_content(const GlbContents& file, const Json& references) {
  Json content;
  for (const auto& [name, accessor] : references.items())
    content[name] = file.numbers(accessor.get<std::size_t>());
  return content;
}

Json mesh_of_node(const GlbContents& file, std::size_t node) {
  Json mesh = file.json["meshes"][file.json["nodes"][node]["mesh"].get<std::size_t>()];
  for (Json& primitive : mesh["primitives"]) {
    primitive["attributes"] = with_content(file, primitive["attributes"]);
    if (primitive.contains("indices"))
      primitive["indices"] = file.numbers(primitive["indices"].get<std::size_t>());
    if (primitive.contains("targets"))
      for (Json& target : primitive["targets"]) target = with_content(file, target);
  }
  return mesh;
}

Json binds_of_node(const GlbContents& file, std::size_t node) {
  Json skin = file.json["skins"][file.json["nodes"][node]["skin"].get<std::size_t>()];
  skin["inverseBindMatrices"] = file.numbers(skin["inverseBindMatrices"].get<std::size_t>());
  return skin;
}

Json animations_of(const GlbContents& file) {
  Json animations = file.json.value("animations", Json());
  for (Json& animation : animations)
    for (Json& sampler : animation["samplers"])
      for (const char* const key : {"input", "output"})
        sampler[key] = file.numbers(sampler[key].get<std::size_t>());
  return animations;
}

Json images_of(const GlbContents& file) {
  Json images = file.json.value("images", Json());
  for (Json& image : images)
    if (image.contains("bufferView")) {
      Json bytes = Json::array();
      for (const std::byte byte : file.bytes_of_view(image["bufferView"].get<std::size_t>()))
        bytes.push_back(std::to_integer<int>(byte));
      image["bufferView"] = std::move(bytes);
    }
  return images;
}

Json instances_of(const GlbContents& file) {
  Json found = Json::array();
  for (const Json& node : file.json["nodes"])
    if (node.contains("extensions"))
      found.push_back(
          with_content(file, node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]));
  return found;
}

void expect_same_beside_meshes(const GlbContents& before, const GlbContents& after) {
  EXPECT_EQ(animations_of(after), animations_of(before));
  EXPECT_EQ(images_of(after), images_of(before));
  EXPECT_EQ(instances_of(after), instances_of(before));
  for (const char* const list : {"materials", "textures", "scenes", "extensions"})
    EXPECT_EQ(after.json.value(list, Json()), before.json.value(list, Json())) << list;
}

void expect_nothing_unused(const GlbContents& file) {
  EXPECT_EQ(file.referenced_accessors().size(), file.json.value("accessors", Json()).size());
  EXPECT_EQ(file.referenced_views().size(), file.json.value("bufferViews", Json()).size());
  EXPECT_LE(file.longest_unreferenced_run(), kPadding);
  EXPECT_TRUE(file.binary.empty() || file.referenced_bytes().at(0));
}

/// Entries to which an unknown extension refers keep their numbers and their content.
void expect_foreign_kept(const RandomDocument& document, const GlbContents& before,
                         const GlbContents& after) {
  std::set<std::size_t> views(document.foreign_views.begin(), document.foreign_views.end());
  for (const std::size_t accessor : document.foreign_accessors) {
    EXPECT_EQ(after.numbers(accessor), before.numbers(accessor));
    const Json& at = after.json["accessors"][accessor];
    if (at.contains("bufferView")) views.insert(at["bufferView"].get<std::size_t>());
    if (at.contains("sparse"))
      views.insert({at["sparse"]["indices"]["bufferView"].get<std::size_t>(),
                    at["sparse"]["values"]["bufferView"].get<std::size_t>()});
    // Any number in the extension may be an accessor, or a view.
    if (accessor < before.json["bufferViews"].size()) views.insert(accessor);
  }
  for (const std::size_t view : document.foreign_views)
    EXPECT_EQ(after.bytes_of_view(view), before.bytes_of_view(view));
  for (const std::size_t view : document.foreign_views)
    if (view < before.json["accessors"].size()) {
      const Json& at = after.json["accessors"][view];
      if (at.contains("bufferView")) views.insert(at["bufferView"].get<std::size_t>());
      if (at.contains("sparse"))
        views.insert({at["sparse"]["indices"]["bufferView"].get<std::size_t>(),
                      at["sparse"]["values"]["bufferView"].get<std::size_t>()});
    }
  EXPECT_LE(after.longest_unreferenced_run(views), kForeignPadding);
}

void expect_vrm_kept(const GlbContents& before, const GlbContents& after) {
  ASSERT_GE(after.json["meshes"].size(), before.json["meshes"].size());
  for (std::size_t i = 0; i < before.json["meshes"].size(); ++i)
    EXPECT_EQ(after.json["meshes"][i]["name"], before.json["meshes"][i]["name"]);
}

void check_random_document(std::uint64_t seed, const fs::path& folder) {
  Random random(seed);
  const RandomDocument document = random_document(random);
  const auto loaded = document.builder.load();
  ASSERT_TRUE(loaded) << loaded.error().text();
  ASSERT_EQ(loaded->character->meshes.size(), document.mesh_nodes.size());
  Character edited = *loaded->character;
  std::vector<Edit> edits;
  for (Mesh& mesh : edited.meshes) {
    edits.push_back(static_cast<Edit>(random.index(3)));
    if (edits.back() == Edit::torn) fake_tear(mesh);
    if (edits.back() == Edit::emptied) retire_all(mesh);
  }
  const auto remain = [](Edit edit) { return edit != Edit::emptied; };
  if (std::none_of(edits.begin(), edits.end(), remain)) return;  // not a model any more
  const GlbContents before(document.builder.glb());
  const fs::path file = folder / (std::to_string(10'000 + seed) + ".glb");
  const GlbContents after = saved(file, edited, *loaded);
  if (read_bytes(file) == document.builder.glb()) return;  // nothing was edited
  expect_same_beside_meshes(before, after);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const std::size_t node = document.mesh_nodes[i];
    SCOPED_TRACE("node " + std::to_string(node));
    EXPECT_EQ(after.json["nodes"][node].contains("mesh"), edits[i] != Edit::emptied);
    if (edits[i] == Edit::emptied) continue;
    EXPECT_EQ(binds_of_node(after, node), binds_of_node(before, node));
    if (edits[i] == Edit::none) {
      EXPECT_EQ(mesh_of_node(after, node), mesh_of_node(before, node));
    }
  }
  if (document.foreign_accessors.empty())
    expect_nothing_unused(after);
  else
    expect_foreign_kept(document, before, after);
  if (document.has_vrm) expect_vrm_kept(before, after);
  const auto again = load_character(file);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->character->clips, loaded->character->clips);
  EXPECT_EQ(again->character->skeleton, loaded->character->skeleton);
}

TEST(UnusedData, of_random_documents_is_left_out_and_all_else_is_kept) {
  const TemporaryFolder folder;
  const auto count = static_cast<std::uint64_t>(stressed(300, 20));
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    check_random_document(seed, folder.path());
    if (HasFailure()) return;
  }
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
  const auto files = files_below(folder.path(), {".glb"});
  const auto reports = validate_glbs_of(folder.path());
  ASSERT_EQ(reports.size(), files.size());
  for (std::size_t i = 0; i < reports.size(); ++i)
    EXPECT_EQ(reports[i].errors, 0) << files[i] << ": " << reports[i].output;
}

// ---- Odd documents

constexpr std::size_t kOtherNode = 3;

/// The strip, and another mesh on node 3 that is never torn.
struct TwoStrips {
  TwoStrips() : builder(skinned_strip()) {
    Json& json = builder.json;
    Json other = json["meshes"][0];
    other["name"] = "other";
    Json& attributes = other["primitives"][0]["attributes"];
    std::vector<float> positions;
    for (int i = 0; i < 30; ++i) positions.push_back(static_cast<float>(i * i % 17) / 16);
    attributes = {{"POSITION", builder.add(positions, "VEC3")},
                  {"JOINTS_0", attributes["JOINTS_0"]},
                  {"WEIGHTS_0", attributes["WEIGHTS_0"]}};
    builder.json["accessors"].back()["min"] = {0, 0, 0};
    builder.json["accessors"].back()["max"] = {1, 1, 1};
    json["meshes"].push_back(other);
    json["nodes"].push_back({{"name", "other"}, {"mesh", 1}, {"skin", 0}});
    json["scenes"][0]["nodes"].push_back(kOtherNode);
    correct_bounds(positions);
  }

  void correct_bounds(const std::vector<float>& positions) {
    Json& accessor = builder.json["accessors"].back();
    for (std::size_t c = 0; c < 3; ++c) {
      float least = 1, greatest = 0;
      for (std::size_t i = c; i < positions.size(); i += 3) {
        least = std::min(least, positions[i]);
        greatest = std::max(greatest, positions[i]);
      }
      accessor["min"][c] = static_cast<double>(least);
      accessor["max"][c] = static_cast<double>(greatest);
    }
  }

  Json& accessor(std::size_t index) { return builder.json["accessors"][index]; }
  Json& view(std::size_t index) { return builder.json["bufferViews"][index]; }
  Json& other_attributes() { return builder.json["meshes"][1]["primitives"][0]["attributes"]; }

  GltfBuilder builder;
};

/// Tears the first mesh. @return the written file, which has no error and keeps the other mesh.
GlbContents torn_beside(const Result<LoadedCharacter>& loaded) {
  EXPECT_TRUE(loaded) << loaded.error().text();
  const TemporaryFolder folder;
  // All content of the source, in one BIN chunk.
  Character edited = *loaded->character;
  fake_tear(edited.meshes[0]);
  const fs::path file = folder.path() / "torn.glb";
  GlbContents after = saved(file, edited, *loaded);
  const auto again = load_character(file, strict());
  EXPECT_TRUE(again) << again.error().text();
  if (again) {
    const Mesh &mesh = again->character->meshes[1], &before = loaded->character->meshes[1];
    EXPECT_TRUE(mesh == before);
    EXPECT_EQ(again->character->clips, loaded->character->clips);
  }
  if (has_gltf_validator()) {
    const ValidatorReport report = validate_glb(file);
    EXPECT_EQ(report.errors, 0) << report.output;
  }
  return after;
}

TEST(UnusedData, of_the_strip_is_left_out) {
  const TwoStrips strips;
  const GlbContents before(strips.builder.glb()), after = torn_beside(strips.builder.load());
  expect_nothing_unused(after);
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
}

TEST(UnusedData, under_a_view_that_overlaps_a_used_one_goes_as_far_as_it_is_unused) {
  TwoStrips strips;
  // The other mesh's positions begin in the middle of the torn mesh's.
  const std::size_t other = strips.other_attributes()["POSITION"];
  Json& view = strips.view(strips.accessor(other)["bufferView"].get<std::size_t>());
  const Json torn = strips.view(strips.accessor(0)["bufferView"].get<std::size_t>());
  view["byteOffset"] = torn["byteOffset"].get<std::size_t>() + 60;
  strips.accessor(other)["count"] = 5;
  strips.other_attributes() = {{"POSITION", other}};
  strips.builder.json["nodes"][kOtherNode].erase("skin");
  view["byteLength"] = 60;
  strips.accessor(other)["min"] = {0, 1, 0};
  strips.accessor(other)["max"] = {1, 2, 0};
  Json& primitive = strips.builder.json["meshes"][1]["primitives"][0];
  primitive["indices"] = strips.builder.add(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR");
  const GlbContents before(strips.builder.glb()), after = torn_beside(strips.builder.load());
  expect_nothing_unused(after);
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
}

TEST(UnusedData, an_image_may_lie_on_the_bytes_of_an_accessor) {
  TwoStrips strips;
  GltfBuilder& builder = strips.builder;
  constexpr const char* kPixel =
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0:~\x9bU\0\0\0\nIDATx\x9c"
      "c\xf8\x0f\0\1\1\1\0\x1b\xb6\xeeV\0\0\0\0IEND\xae\x42`\x82";
  const std::vector<std::uint8_t> bytes(kPixel, kPixel + 67);
  const std::size_t view = builder.add_view(bytes);
  builder.json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", 5121}, {"count", kStripVertices}, {"type", "VEC4"}});
  strips.other_attributes()["_PIXEL"] = builder.json["accessors"].size() - 1;
  builder.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  const GlbContents before(builder.glb()), after = torn_beside(builder.load());
  EXPECT_EQ(images_of(after), images_of(before));
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
  EXPECT_LT(after.binary.size(), before.binary.size() + 1000);
  expect_nothing_unused(after);
}

TEST(UnusedData, sparse_accessors_keep_their_parts_with_and_without_a_base) {
  TwoStrips strips;
  GltfBuilder& builder = strips.builder;
  // Indices and values in one view.
  std::vector<std::uint8_t> parts = {2, 0, 7, 0};
  const std::array<float, 6> values = {0.5f, 0.25f, 0.125f, -0.5f, -0.25f, -0.125f};
  parts.resize(4 + sizeof values);
  std::memcpy(parts.data() + 4, values.data(), sizeof values);
  const std::size_t view = builder.add_view(parts);
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", view}, {"componentType", 5123}}},
                       {"values", {{"bufferView", view}, {"byteOffset", 4}}}};
  builder.json["accessors"].push_back(
      {{"componentType", 5126}, {"count", kStripVertices}, {"type", "VEC3"}, {"sparse", sparse}});
  strips.other_attributes()["_SPARSE"] = builder.json["accessors"].size() - 1;
  Json with_base = builder.json["accessors"].back();
  // The base are the positions of the torn mesh, which stay for its sake.
  with_base["bufferView"] = strips.accessor(0)["bufferView"];
  builder.json["accessors"].push_back(with_base);
  strips.other_attributes()["_BASED"] = builder.json["accessors"].size() - 1;
  const GlbContents before(builder.glb()), after = torn_beside(builder.load());
  expect_nothing_unused(after);
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
}

TEST(UnusedData, views_of_several_strides_on_the_same_bytes_stay_apart_by_whole_strides) {
  TwoStrips strips;
  GltfBuilder& builder = strips.builder;
  // Two blocks of ten vertices for the other mesh, and one for the torn mesh between them, in
  // three views of all bytes with strides of 24, 12 and 8.
  std::vector<float> data;
  for (int i = 0; i < 180; ++i) data.push_back(static_cast<float>(i % 13) / 16);
  const std::size_t wide = builder.add_view(data);
  strips.view(wide)["byteStride"] = 24;
  const auto add_view = [&](std::size_t stride) {
    Json copy = strips.view(wide);
    copy["byteStride"] = stride;
    builder.json["bufferViews"].push_back(copy);
    return builder.json["bufferViews"].size() - 1;
  };
  const auto add = [&](std::size_t view, std::size_t offset, const char* type) {
    builder.json["accessors"].push_back({{"bufferView", view},
                                         {"byteOffset", offset},
                                         {"componentType", 5126},
                                         {"count", kStripVertices},
                                         {"type", type}});
    return builder.json["accessors"].size() - 1;
  };
  const std::size_t middle = add_view(12), narrow = add_view(8);
  strips.other_attributes()["_A"] = add(wide, 12, "VEC3");
  strips.other_attributes()["_B"] = add(wide, 480, "VEC2");
  strips.other_attributes()["_C"] = add(middle, 24, "VEC3");
  strips.other_attributes()["_D"] = add(narrow, 640, "VEC2");
  strip_attributes(builder)["_TORN"] = add(wide, 240, "VEC2");
  const GlbContents before(builder.glb()), after = torn_beside(builder.load());
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
  // What stays in a gap is shorter than the least common multiple of the strides.
  EXPECT_LT(after.longest_unreferenced_run(), 24u);
}

TEST(UnusedData, the_last_stride_of_a_view_may_be_short) {
  TwoStrips strips;
  GltfBuilder& builder = strips.builder;
  const std::vector<float> data(10 * 5 - 2, 0.5f);
  const std::size_t view = builder.add_view(data);
  strips.view(view)["byteStride"] = 20;
  builder.json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", 5126}, {"count", 10}, {"type", "VEC3"}});
  strips.other_attributes()["_SHORT"] = builder.json["accessors"].size() - 1;
  const GlbContents before(builder.glb()), after = torn_beside(builder.load());
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
  expect_nothing_unused(after);
}

TEST(UnusedData, accessors_without_a_view_are_zeros_and_stay) {
  TwoStrips strips;
  strips.builder.json["accessors"].push_back(
      {{"componentType", 5126}, {"count", kStripVertices}, {"type", "VEC2"}});
  strips.other_attributes()["TEXCOORD_0"] = strips.builder.json["accessors"].size() - 1;
  const GlbContents before(strips.builder.glb()), after = torn_beside(strips.builder.load());
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
  expect_nothing_unused(after);
}

TEST(UnusedData, of_several_buffers_is_left_out_of_all) {
  const TwoStrips strips;
  const GlbContents before(strips.builder.glb());
  // The same bytes in two buffers: the first is missing what the views of the second have.
  Json text = Json::parse(strips.builder.text());
  text["buffers"].push_back(text["buffers"][0]);
  for (std::size_t i = 0; i < text["bufferViews"].size(); i += 2)
    text["bufferViews"][i]["buffer"] = 1;
  const GlbContents after = torn_beside(load_text(text.dump()));
  EXPECT_EQ(mesh_of_node(after, kOtherNode), mesh_of_node(before, kOtherNode));
  EXPECT_EQ(after.json["buffers"].size(), 1u);
  expect_nothing_unused(after);
}

TEST(UnusedData, instances_that_nobody_checked_do_no_harm) {
  for (const Json& attributes :
       {Json{{"TRANSLATION", 999}}, Json{{"TRANSLATION", "no number"}}, Json{{"TRANSLATION", -1}},
        Json::array({1, 2}), Json("text"), Json(7)}) {
    TwoStrips strips;
    strips.builder.json["nodes"][kOtherNode]["extensions"]["EXT_mesh_gpu_instancing"] = {
        {"attributes", attributes}};
    const Result<LoadedCharacter> loaded = strips.builder.load();
    ASSERT_TRUE(loaded) << attributes << loaded.error().text();
    Character edited = *loaded->character;
    fake_tear(edited.meshes[0]);
    const GlbContents after = saved(edited, *loaded);
    EXPECT_EQ(mesh_of_node(after, kOtherNode)["name"], "other");
    EXPECT_EQ(after.json["nodes"][kOtherNode]["extensions"],
              strips.builder.json["nodes"][kOtherNode]["extensions"]);
  }
  // An accessor with more elements than there can be.
  TwoStrips strips;
  strips.builder.json["accessors"].push_back({{"bufferView", 0},
                                              {"componentType", 5126},
                                              {"count", std::uint64_t{1} << 52},
                                              {"type", "MAT4"}});
  strips.builder.json["nodes"][kOtherNode]["extensions"]["EXT_mesh_gpu_instancing"] = {
      {"attributes", {{"TRANSLATION", strips.builder.json["accessors"].size() - 1}}}};
  const Result<LoadedCharacter> loaded = strips.builder.load();
  if (!loaded) return;
  Character edited = *loaded->character;
  fake_tear(edited.meshes[0]);
  EXPECT_GT(saved(edited, *loaded).binary.size(), 0u);
}

TEST(UnusedData, stays_where_an_unknown_extension_has_offsets_of_its_own) {
  TwoStrips strips;
  strips.builder.json["extensionsUsed"] = {"ACME_stream"};
  strips.builder.json["extensions"]["ACME_stream"] = {{"buffer", 0}, {"byteOffset", 8}};
  const GlbContents before(strips.builder.glb()), after = torn_beside(strips.builder.load());
  ASSERT_GE(after.binary.size(), before.binary.size());
  EXPECT_TRUE(std::equal(before.binary.begin(), before.binary.end(), after.binary.begin()));
}

TEST(UnusedData, numbers_of_a_vrm_stay_those_of_its_nodes_and_meshes) {
  TwoStrips strips;
  Json& json = strips.builder.json;
  json["extensionsUsed"] = {"VRM", "VRMC_vrm"};
  json["extensions"]["VRM"] = {
      {"exporterVersion", "test"},
      {"humanoid",
       {{"humanBones", {{{"bone", "hips"}, {"node", 1}}, {{"bone", "head"}, {"node", 2}}}}}},
      {"firstPerson", {{"meshAnnotations", {{{"mesh", 1}, {"firstPersonFlag", "Both"}}}}}}};
  json["extensions"]["VRMC_vrm"] = {
      {"specVersion", "1.0"},
      {"humanoid", {{"humanBones", {{"hips", {{"node", 1}}}, {"head", {{"node", 2}}}}}}}};
  const GlbContents before(strips.builder.glb());
  const Result<LoadedCharacter> loaded = load_bytes("avatar.vrm", strips.builder.glb());
  GlbContents after = torn_beside(loaded);
  EXPECT_EQ(after.json["extensions"], json["extensions"]);
  EXPECT_EQ(after.json["meshes"][1]["name"], "other");
  expect_nothing_unused(after);
  // A mesh without a triangle keeps its number.
  Character emptied = *loaded->character;
  retire_all(emptied.meshes[0]);
  after = saved(emptied, *loaded);
  EXPECT_EQ(after.json["extensions"], json["extensions"]);
  EXPECT_EQ(after.json["meshes"][0]["name"], "strip");
  EXPECT_EQ(after.json["meshes"][1]["name"], "other");
  EXPECT_FALSE(after.json["nodes"][0].contains("mesh"));
  expect_nothing_unused(after);
}

TEST(UnusedData, a_mesh_without_triangles_takes_its_number_with_it) {
  const TwoStrips strips;
  const auto loaded = strips.builder.load();
  ASSERT_TRUE(loaded);
  Character emptied = *loaded->character;
  retire_all(emptied.meshes[0]);
  const GlbContents after = saved(emptied, *loaded);
  ASSERT_EQ(after.json["meshes"].size(), 1u);
  EXPECT_EQ(after.json["meshes"][0]["name"], "other");
  EXPECT_EQ(after.json["nodes"][kOtherNode]["mesh"], 0);
  expect_nothing_unused(after);
}

// ---- Models that are there

int unused_objects(const ValidatorReport& report) {
  return Json::parse(report.output)["unused"].get<int>();
}

TEST(UnusedData, of_rigged_models_is_left_out) {
  for (const fs::path& source : rigged_gltf_models()) {
    SCOPED_TRACE(source);
    const auto loaded = load_character(source);
    ASSERT_TRUE(loaded) << loaded.error().text();
    const TemporaryFolder folder;
    const fs::path whole = folder.path() / "0.glb", torn = folder.path() / "1.glb";
    const GlbContents before = saved(whole, *loaded->character, *loaded);
    Character edited = *loaded->character;
    fake_tear(edited.meshes.back(), 20);
    const GlbContents after = saved(torn, edited, *loaded);
    expect_nothing_unused(after);
    expect_same_beside_meshes(before, after);
    if (!has_gltf_validator()) continue;
    EXPECT_LE(unused_objects(validate_glb(torn)), unused_objects(validate_glb(whole)));
  }
}

}  // namespace
}  // namespace sunder::test
