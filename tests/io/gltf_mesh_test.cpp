// load_character() on glTF: triangles and vertex data.

#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

Json& primitive_of(GltfBuilder& builder) { return builder.json["meshes"][0]["primitives"][0]; }

const Mesh& first_mesh(const Result<LoadedCharacter>& loaded) {
  return loaded->character->meshes.at(0);
}

TEST(LoadGltfMesh, attributes_and_triangles_are_read) {
  const auto loaded = skinned_strip().load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Mesh& mesh = first_mesh(loaded);
  EXPECT_EQ(mesh.name, "strip");
  ASSERT_EQ(mesh.positions.size(), kStripVertices);
  EXPECT_EQ(mesh.positions[3], Vec3f(1, 0.5f, 0));
  EXPECT_EQ(mesh.uv_sets.at(0)[3], Vec2f(1, 0.25f));
  EXPECT_EQ(mesh.triangles.size(), 8u);
  EXPECT_EQ(mesh.triangles[1], (Triangle{1, 3, 2}));
  EXPECT_EQ(mesh.submeshes.at(0).name, "skin");
  EXPECT_EQ(loaded->report.format, "glTF 2.0 binary");
  EXPECT_EQ(load_text(skinned_strip().text())->report.format, "glTF 2.0 text");
}

TEST(LoadGltfMesh, strips_and_fans_become_triangles) {
  GltfBuilder builder = skinned_strip();
  primitive_of(builder)["indices"] =
      builder.add(std::vector<std::uint8_t>{0, 1, 2, 3, 3, 4}, "SCALAR");
  primitive_of(builder)["mode"] = 5;
  EXPECT_EQ(first_mesh(builder.load(strict())).triangles,
            (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  primitive_of(builder)["indices"] = builder.add(std::vector<std::uint32_t>{0, 1, 2, 3}, "SCALAR");
  primitive_of(builder)["mode"] = 6;
  EXPECT_EQ(first_mesh(builder.load(strict())).triangles,
            (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}}));
}

TEST(LoadGltfMesh, without_indices_every_three_vertices_are_a_triangle) {
  GltfBuilder builder = skinned_strip();
  primitive_of(builder).erase("indices");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(first_mesh(loaded).triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "incomplete"));
}

TEST(LoadGltfMesh, primitives_on_the_same_vertices_are_one_mesh) {
  GltfBuilder builder = skinned_strip();
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 1;
  primitives.push_back(primitives[0]);
  primitives[2]["attributes"].erase("NORMAL");
  primitives.push_back({{"attributes", primitives[0]["attributes"]}, {"mode", 0}});
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  ASSERT_EQ(loaded->character->meshes.size(), 2u);
  EXPECT_EQ(first_mesh(loaded).name, "strip.0");
  EXPECT_EQ(first_mesh(loaded).submeshes.size(), 2u);
  EXPECT_EQ(first_mesh(loaded).triangles.size(), 16u);
  EXPECT_EQ(first_mesh(loaded).triangle_submesh[8], 1u);
  EXPECT_EQ(loaded->character->meshes[1].name, "strip.2");
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "points and lines"));
}

TEST(LoadGltfMesh, triangles_of_vertices_that_do_not_exist_are_dropped) {
  GltfBuilder builder = skinned_strip();
  primitive_of(builder)["indices"] =
      builder.add(std::vector<std::uint16_t>{0, 1, 2, 1, 77, 2}, "SCALAR");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(first_mesh(loaded).triangles.size(), 1u);
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::index_out_of_range);
}

TEST(LoadGltfMesh, interleaved_and_unaligned_data_is_read) {
  GltfBuilder builder = skinned_strip();
  std::vector<std::uint8_t> bytes(3 + 16 * kStripVertices);
  for (std::size_t v = 0; v < kStripVertices; ++v) {
    const float position[3] = {static_cast<float>(v), 2, 3};
    std::memcpy(bytes.data() + 3 + v * 16, position, sizeof position);
  }
  const std::size_t view = builder.add_view(bytes);
  builder.json["bufferViews"][view]["byteStride"] = 16;
  builder.json["accessors"].push_back({{"bufferView", view},
                                       {"byteOffset", 3},
                                       {"componentType", 5126},
                                       {"count", kStripVertices},
                                       {"type", "VEC3"}});
  strip_attributes(builder)["POSITION"] = builder.json["accessors"].size() - 1;
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(first_mesh(loaded).positions[9], Vec3f(9, 2, 3));
}

TEST(LoadGltfMesh, sparse_data_replaces_elements_with_and_without_a_base) {
  GltfBuilder builder = skinned_strip();
  const std::size_t indices = builder.add_view(std::vector<std::uint8_t>{1, 4});
  const std::size_t values = builder.add_view(std::vector<float>{7, 8, 9, 4, 5, 6});
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                       {"values", {{"bufferView", values}}}};
  builder.json["accessors"][0]["sparse"] = sparse;
  builder.json["accessors"].push_back(
      {{"componentType", 5126}, {"count", kStripVertices}, {"type", "VEC3"}, {"sparse", sparse}});
  primitive_of(builder)["targets"] =
      Json::array({{{"POSITION", builder.json["accessors"].size() - 1}}});
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Mesh& mesh = first_mesh(loaded);
  EXPECT_EQ(mesh.positions[1], Vec3f(7, 8, 9));
  EXPECT_EQ(mesh.positions[4], Vec3f(4, 5, 6));
  EXPECT_EQ(mesh.positions[3], Vec3f(1, 0.5f, 0));
  EXPECT_EQ(mesh.morph_targets.at(0).position_deltas[0], Vec3f(0, 0, 0));
  EXPECT_EQ(mesh.morph_targets.at(0).position_deltas[4], Vec3f(4, 5, 6));
}

TEST(LoadGltfMesh, quantised_vertices_are_decoded) {
  GltfBuilder builder = skinned_strip();
  builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  std::vector<std::int16_t> positions(kStripVertices * 3);
  std::vector<std::int8_t> normals(kStripVertices * 3);
  std::vector<std::uint16_t> uvs(kStripVertices * 2, 65535);
  for (std::size_t v = 0; v < kStripVertices; ++v) {
    positions[v * 3] = static_cast<std::int16_t>(-300 + static_cast<int>(v));
    normals[v * 3 + 2] = 127;
  }
  for (std::size_t c = 0; c < 3; ++c)  // the byte vector nearest to a direction; 0.0065 too short
    normals[3 + c] = std::array<std::int8_t, 3>{58, 61, 94}[c];
  strip_attributes(builder)["POSITION"] = builder.add(positions, "VEC3");
  strip_attributes(builder)["NORMAL"] = builder.add(normals, "VEC3", true);
  strip_attributes(builder)["TEXCOORD_0"] = builder.add(uvs, "VEC2", true);
  strip_attributes(builder)["COLOR_0"] =
      builder.add(std::vector<std::uint8_t>(kStripVertices * 3, 51), "VEC3", true);
  strip_attributes(builder)["_LABEL"] =
      builder.add(std::vector<std::uint8_t>(kStripVertices, 200), "SCALAR");
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Mesh& mesh = first_mesh(loaded);
  EXPECT_EQ(mesh.positions[2], Vec3f(-298, 0, 0));
  EXPECT_EQ(mesh.normals[1], Vec3f(58 / 127.0f, 61 / 127.0f, 94 / 127.0f));
  EXPECT_EQ(mesh.normals[2], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.uv_sets[0][2], Vec2f(1, 1));
  EXPECT_EQ(mesh.color_sets.at(0)[2], Vec4f(0.2f, 0.2f, 0.2f, 1));
  EXPECT_EQ(mesh.custom_attributes.at(0).values[2], 200.0f);
  EXPECT_FALSE(mesh.custom_attributes[0].interpolates);
}

TEST(LoadGltfMesh, a_position_that_is_not_finite_is_always_refused) {
  GltfBuilder builder = skinned_strip();
  std::vector<float> positions(kStripVertices * 3, 1.0f);
  positions[14] = INFINITY;
  strip_attributes(builder)["POSITION"] = builder.add(positions, "VEC3");
  const Status error = builder.load().error();
  EXPECT_EQ(error.code(), StatusCode::non_finite_value);
  EXPECT_EQ(error.index(), 4u);
}

TEST(LoadGltfMesh, other_attributes_that_are_not_finite_are_dropped_or_made_zero) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)["NORMAL"] =
      builder.add(std::vector<float>(kStripVertices * 3, std::nanf("")), "VEC3");
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::non_finite_value);
  strip_attributes(builder)["TEXCOORD_0"] =
      builder.add(std::vector<float>(kStripVertices * 2, std::nanf("")), "VEC2");
  strip_attributes(builder)["_HEAT"] =
      builder.add(std::vector<float>(kStripVertices, INFINITY), "SCALAR");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_TRUE(first_mesh(loaded).normals.empty());
  EXPECT_TRUE(first_mesh(loaded).custom_attributes.empty());
  EXPECT_EQ(first_mesh(loaded).uv_sets.at(0)[0], Vec2f(0, 0));
}

TEST(LoadGltfMesh, normals_far_from_unit_length_are_normalised) {
  GltfBuilder builder = skinned_strip();
  std::vector<float> normals(kStripVertices * 3, 0.0f);
  normals[1] = 5.0f;
  strip_attributes(builder)["NORMAL"] = builder.add(normals, "VEC3");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(first_mesh(loaded).normals[0], Vec3f(0, 1, 0));
  EXPECT_EQ(first_mesh(loaded).normals[1].norm(), 1.0f);
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::malformed_file);
}

TEST(LoadGltfMesh, tear_sides_are_found_under_the_name_that_tools_keep) {
  std::vector<float> sides(kStripVertices, 0.0f), others(kStripVertices, 7.0f);
  sides[3] = 2.0f;
  for (const bool as_integers : {false, true}) {
    GltfBuilder builder = skinned_strip();
    const std::vector<std::uint16_t> integers(sides.begin(), sides.end());
    strip_attributes(builder)[kTearSideFeatureAttribute] =
        as_integers ? builder.add(integers, "SCALAR") : builder.add(sides, "SCALAR");
    const auto loaded = builder.load(strict());
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    const CustomAttribute expected{kTearSideAttribute, 1, false, sides};
    EXPECT_EQ(first_mesh(loaded).custom_attributes, std::vector<CustomAttribute>{expected});
  }
  for (const bool is_first : {false, true}) {  // If both are present, the attribute itself is used.
    GltfBuilder builder = skinned_strip();
    if (is_first)
      strip_attributes(builder)[kTearSideFeatureAttribute] = builder.add(others, "SCALAR");
    strip_attributes(builder)[kTearSideAttribute] = builder.add(sides, "SCALAR");
    if (!is_first)
      strip_attributes(builder)[kTearSideFeatureAttribute] = builder.add(others, "SCALAR");
    const auto loaded = builder.load(strict());
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    ASSERT_EQ(first_mesh(loaded).custom_attributes.size(), 1u);
    EXPECT_EQ(first_mesh(loaded).custom_attributes[0].name, kTearSideAttribute);
    EXPECT_EQ(first_mesh(loaded).custom_attributes[0].values, sides);
    EXPECT_TRUE(loaded->report.notes.empty());
  }
}

TEST(LoadGltfMesh, other_things_of_that_name_are_dropped) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)[kTearSideFeatureAttribute] =
      builder.add(std::vector<float>(kStripVertices * 2, 1.0f), "VEC2");
  strip_attributes(builder)["_FEATURE_ID_0"] =
      builder.add(std::vector<float>(kStripVertices, 1.0f), "SCALAR");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  ASSERT_EQ(first_mesh(loaded).custom_attributes.size(), 1u);
  EXPECT_EQ(first_mesh(loaded).custom_attributes[0].name, "_FEATURE_ID_0");
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "not have one number per vertex"));
}

TEST(LoadGltfMesh, matrix_attributes_stay_in_the_file_only) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder)["_FRAME"] =
      builder.add(std::vector<float>(kStripVertices * 16, 1.0f), "MAT4");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_TRUE(first_mesh(loaded).custom_attributes.empty());
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "matrices"));
}

TEST(LoadGltfFiles, external_buffers_are_read_from_the_files_folder_alone) {
  const TemporaryFolder outer;
  const GltfBuilder builder = skinned_strip();
  outer.write("outside.bin", builder.binary());
  outer.write("asset/sub/inside part.bin", builder.binary());
  std::filesystem::create_symlink(outer.path() / "outside.bin",
                                  outer.path() / "asset" / "link.bin");
  const auto load_with = [&](const std::string& uri) {
    return load_character(outer.write("asset/model.gltf", builder.text_with_uri(uri)));
  };
  EXPECT_TRUE(load_with("sub/inside%20part.bin").has_value());
  EXPECT_TRUE(load_with("sub/../sub/inside part.bin").has_value());
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("sub/../../outside.bin"),
        std::string("%2e%2e/outside.bin"), (outer.path() / "outside.bin").string(),
        "file://" + (outer.path() / "outside.bin").string(),
        std::string("http://example.com/a.bin"), std::string("link.bin"), std::string("a%00b")})
    EXPECT_EQ(load_with(uri).error().code(), StatusCode::path_not_allowed) << uri;
  EXPECT_EQ(load_with("missing.bin").error().code(), StatusCode::file_not_found);
  EXPECT_EQ(load_with("sub").error().code(), StatusCode::file_unreadable);
}

TEST(LoadGltfFiles, external_buffers_may_be_in_further_roots) {
  const TemporaryFolder outer;
  const GltfBuilder builder = skinned_strip();
  outer.write("library/part.bin", builder.binary());
  outer.write("outside.bin", builder.binary());
  std::filesystem::create_symlink(outer.path() / "outside.bin",
                                  outer.path() / "library" / "link.bin");
  LoadOptions options;
  options.roots = {outer.path() / "absent", outer.path() / "library"};
  const auto load_with = [&](const std::string& uri) {
    return load_character(outer.write("asset/model.gltf", builder.text_with_uri(uri)), options);
  };
  EXPECT_TRUE(load_with("part.bin").has_value());
  EXPECT_TRUE(load_with("../library/part.bin").has_value());
  for (const char* const uri : {"../outside.bin", "link.bin"})
    EXPECT_EQ(load_with(uri).error().code(), StatusCode::path_not_allowed) << uri;
  EXPECT_EQ(load_with("missing.bin").error().code(), StatusCode::file_not_found);
}

TEST(LoadGltfMesh, an_odd_list_of_used_extensions_does_not_matter) {
  for (const Json& odd : {Json(nullptr), Json(7), Json::array({1, nullptr})}) {
    GltfBuilder builder = skinned_strip();
    builder.json["extensionsUsed"] = odd;
    const auto loaded = builder.load();
    EXPECT_TRUE(loaded) << odd.dump() << ": " << loaded.error().text();
  }
}

}  // namespace
}  // namespace sunder::test
