// One rule for all formats: what names a vertex, normal, joint or weight that does not exist is
// dropped and counted, or the file is refused; a strict reading always refuses it. Nothing is
// accepted silently.

#include <algorithm>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

std::string with(std::string text, const std::string& part, const std::string& replacement) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), replacement);
}

Result<LoadedCharacter> load(const char* name, const std::string& content,
                             const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  return load_character(folder.write(name, content), options);
}

bool has_loss(const LoadReport& report) {
  return std::any_of(report.notes.begin(), report.notes.end(),
                     [](const LoadNote& note) { return note.kind != LoadNote::Kind::information; });
}

/// The file is accepted, without the face that names vertex 9.
void expect_face_dropped(const char* name, const std::string& content) {
  SCOPED_TRACE(name);
  const auto loaded = load(name, content);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->character->meshes[0].triangle_count(), 2u);
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "vertices that do not exist"));
  EXPECT_EQ(load(name, content, strict()).error().code(), StatusCode::index_out_of_range);
}

void expect_told_or_refused(const char* name, const std::string& content) {
  SCOPED_TRACE(name);
  const auto loaded = load(name, content);
  EXPECT_TRUE(!loaded || has_loss(loaded->report)) << "accepted silently:\n" << content;
  EXPECT_FALSE(load(name, content, strict()));
}

void expect_refused(const char* name, const std::string& content) {
  SCOPED_TRACE(name);
  const auto loaded = load(name, content);
  EXPECT_EQ(loaded.error().code(), StatusCode::malformed_file) << loaded.error().text();
}

const std::string kOff =
    "OFF\n# a comment\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 9\n3 0 2 3\n";

TEST(IndicesOutOfRange, off) {
  expect_face_dropped("a.off", kOff);
  expect_face_dropped("a.off", with(kOff, "3 0 2 9", "4 0 1 2 9"));
  expect_face_dropped("a.off", with(kOff, "3 0 2 9", "3 0 2 -1"));
  // assimp leaves out faces without corners, so later faces move up.
  expect_face_dropped("a.off", with(with(kOff, "4 3 0", "4 4 0"), "3 0 1 2", "0\n3 0 1 2"));
}

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 9\n3 0 2 3\n";

TEST(IndicesOutOfRange, ply) {
  expect_face_dropped("a.ply", kPly);
  expect_face_dropped("a.ply", with(kPly, "3 0 2 9", "3 0 2 -1"));
  expect_face_dropped("a.ply", with(kPly, "3 0 2 9", "4 0 1 2 9"));
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 9\nf 1 3 4\n";

TEST(IndicesOutOfRange, obj) {
  expect_refused("a.obj", kObj);
  expect_refused("a.obj", with(kObj, "f 1 3 9", "f -9 -2 -1"));
  expect_told_or_refused("a.obj", "vn 0 0 1\n" + with(kObj, "f 1 3 9", "f 1//1 3//7 2//1"));
  expect_told_or_refused("a.obj", "vt 0 0\n" + with(kObj, "f 1 3 9", "f 1/1 3/7 2/1"));
}

const std::string kX =
    "xof 0303txt 0032\nMesh m {\n4;\n0;0;0;, 1;0;0;, 1;1;0;, 0;1;0;;\n3;\n3;0,1,2;, 3;0,2,9;, "
    "3;0,2,3;;\n";

TEST(IndicesOutOfRange, x) {
  expect_told_or_refused("a.x", kX + "}\n");
  expect_told_or_refused("a.x", with(kX, "0,2,9", "0,2,1") +
                                    "MeshNormals {\n1;\n0;0;1;;\n3;\n3;0,0,0;, 3;0,0,7;, "
                                    "3;0,0,0;;\n}\n}\n");
}

const std::string kCollada =
    R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="n"><float_array id="na" count="3">0 0 1</float_array><technique_common>
<accessor source="#na" count="1" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/><p>0 0 1 0 2 0 0 0 2 0 3 0</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="N"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

TEST(IndicesOutOfRange, collada) {
  ASSERT_TRUE(load("a.dae", kCollada));
  expect_refused("a.dae", with(kCollada, "2 0 3 0</p>", "2 0 9 0</p>"));
  expect_refused("a.dae", with(kCollada, "2 0 3 0</p>", "2 0 3 9</p>"));
}

const std::string kMd5 =
    "MD5Version 10\ncommandline \"\"\n\nnumJoints 2\nnumMeshes 1\n\njoints {\n\t\"origin\"\t-1 ( 0 "
    "0 0 ) ( 0 0 0 )\n\t\"upper\"\t0 ( 0 0 1 ) ( 0 0 0 )\n}\n\nmesh {\n\tshader "
    "\"x\"\n\n\tnumverts "
    "4\n\tvert 0 ( 0 0 ) 0 1\n\tvert 1 ( 1 0 ) 1 1\n\tvert 2 ( 1 1 ) 2 1\n\tvert 3 ( 0 1 ) 3 "
    "1\n\n\tnumtris 2\n\ttri 0 0 1 2\n\ttri 1 0 2 3\n\n\tnumweights 4\n\tweight 0 0 1 ( 0 0 0 "
    ")\n\tweight 1 0 1 ( 1 0 0 )\n\tweight 2 1 1 ( 1 1 0 )\n\tweight 3 1 1 ( 0 1 0 )\n}\n";

TEST(IndicesOutOfRange, md5) {
  ASSERT_TRUE(load("a.md5mesh", kMd5));
  expect_told_or_refused("a.md5mesh", with(kMd5, "tri 1 0 2 3", "tri 1 0 2 9"));
  expect_told_or_refused("a.md5mesh", with(kMd5, "tri 1 0 2 3", "tri 1 0 2 5"));
  expect_told_or_refused("a.md5mesh", with(kMd5, "weight 2 1 1", "weight 2 7 1"));
  expect_told_or_refused("a.md5mesh", with(kMd5, "( 0 1 ) 3 1", "( 0 1 ) 3 4"));
}

TEST(IndicesOutOfRange, glb) {
  GltfBuilder builder = skinned_strip();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  for (const int mode : {4, 5, 6}) {
    primitive["mode"] = mode;
    primitive["indices"] =
        builder.add(std::vector<std::uint16_t>{0, 1, 2, 1, 2, 99, 1, 3, 2}, "SCALAR");
    const auto loaded = builder.load();
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "vertices that do not exist"));
    EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::index_out_of_range);
  }
  // Nothing is left: there is no model to drop it from.
  primitive["mode"] = 4;
  primitive["indices"] = builder.add(std::vector<std::uint16_t>{97, 98, 99}, "SCALAR");
  EXPECT_EQ(builder.load().error().code(), StatusCode::empty_input);
}

/// References without which there is no model are refused by both.
TEST(IndicesOutOfRange, glb_references_of_the_document) {
  for (const char* const pointer :
       {"/nodes/0/mesh", "/nodes/0/skin", "/nodes/1/children/0", "/skins/0/joints/1", "/scene",
        "/meshes/0/primitives/0/attributes/POSITION", "/meshes/0/primitives/0/indices",
        "/meshes/0/primitives/0/material", "/skins/0/inverseBindMatrices"}) {
    GltfBuilder builder = skinned_strip();
    builder.json[Json::json_pointer(pointer)] = 99;
    EXPECT_EQ(builder.load().error().code(), StatusCode::index_out_of_range) << pointer;
    EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::index_out_of_range) << pointer;
  }
}

/// A channel of an animation can be left out.
TEST(IndicesOutOfRange, glb_targets_of_animations) {
  GltfBuilder builder = skinned_strip();
  const std::size_t times = builder.add(std::vector<float>{0, 1}, "SCALAR"),
                    values = builder.add(std::vector<float>(6, 1.0f), "VEC3");
  builder.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 99}, {"path", "scale"}}}}}},
       {"samplers", {{{"input", times}, {"output", values}}}}}};
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "its node does not exist"));
  EXPECT_FALSE(builder.load(strict()));
}

}  // namespace
}  // namespace sunder::test
