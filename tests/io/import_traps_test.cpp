// Texts that assimp's importers read for minutes or with a stack that overflows are refused before
// assimp sees them, and valid files like them are not. The imports run in this process: nothing
// stops a hang here but the test's own time limit.

#include <sunder/io/character_file.h>

#include <string>

#include <gtest/gtest.h>

#include "io/assimp_text_models.h"
#include "io/contained_import/import_as_glb.h"
#include "io/import_checks/check_text.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string all;
  all.reserve(text.size() * static_cast<std::size_t>(times));
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

class ImportTraps : public testing::Test {
 protected:
  Status import(const std::string& name, const std::string& content) {
    LoadOptions options;
    options.import_place = ImportPlace::in_process;
    return contained_import::import_as_glb(folder_.write(name, std::string_view(content)), options)
        .error();
  }
  void expect(const std::string& name, const std::string& content, StatusCode code,
              const char* text) {
    const Status status = import(name, content);
    EXPECT_EQ(status.code(), code) << name << ": " << status.text();
    EXPECT_NE(status.text().find(text), std::string_view::npos) << status.text();
    EXPECT_NE(status.text().find(name), std::string_view::npos) << status.text();
  }

  test::TemporaryFolder folder_;
};

std::string ply(const std::string& elements, const std::string& content,
                const char* format = "ascii") {
  return "ply\nformat " + std::string(format) + " 1.0\n" + elements + "end_header\n" + content;
}

const std::string kPoint = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "property list uchar int vertex_indices\n";
const std::string kThree = "0 0 0\n1 0 0\n0 1 0\n";

TEST_F(ImportTraps, PlyHeaderWithoutEnd) {
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
  ASSERT_EQ(header.size(), 55u);
  expect("a.ply", header, StatusCode::malformed_file, "end_header");
  expect("b.ply", "ply\n", StatusCode::malformed_file, "end_header");
  expect("c.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + kPoint,
         StatusCode::malformed_file, "end_header");
  expect("d.ply", "ply\nformat ascii 1.0\ncomment " + std::string(2'000'000, 'x') + "\n",
         StatusCode::limit_exceeded, "header");
  expect("e.ply", "ply\nformat ascii 1.0\n" + repeated("element e 1\nproperty float x\n", 100'000),
         StatusCode::limit_exceeded, "header");
}

TEST_F(ImportTraps, PlyCountsWithoutContent) {
  const std::string faces = "element face 1\n" + kFaces;
  expect("a.ply", ply("element vertex 20000000\n" + kPoint + faces, "0 0 0\n"),
         StatusCode::malformed_file, "20000000 × 'vertex'");
  expect("b.ply", ply("element vertex 3\n" + kPoint + "element face 2000000000\n" + kFaces, kThree),
         StatusCode::malformed_file, "2000000000 × 'face'");
  expect("c.ply", ply("element vertex 99999999999999999999999\n" + kPoint, ""),
         StatusCode::malformed_file, "'vertex'");
  expect("d.ply",
         ply("element vertex 3\n" + kPoint + faces, std::string(35, '\0'), "binary_little_endian"),
         StatusCode::malformed_file, "'vertex'");
  expect("e.ply", ply("element vertex\n" + kPoint, ""), StatusCode::malformed_file, "no count");
  expect("f.ply", ply("element nothing 1000000000\n", ""), StatusCode::malformed_file, "'nothing'");
}

TEST_F(ImportTraps, PlyThatIsJustLargeEnough) {
  const std::string faces = "element face 1\n" + kFaces;
  EXPECT_TRUE(import("a.ply", ply("element vertex 3\n" + kPoint + faces, kThree + "3 0 1 2")));
  EXPECT_TRUE(import("b.ply", test::kTornPly));
  std::string binary(36, '\0');
  const float one = 1.0f;
  std::copy_n(reinterpret_cast<const char*>(&one), 4, binary.begin() + 12);
  std::copy_n(reinterpret_cast<const char*>(&one), 4, binary.begin() + 28);
  binary += std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  EXPECT_TRUE(
      import("c.ply", ply("element vertex 3\n" + kPoint + faces, binary, "binary_little_endian")));
  // Line ends of other systems.
  std::string carriage = ply("element vertex 3\n" + kPoint + faces, kThree + "3 0 1 2\n");
  for (std::size_t at = 0; (at = carriage.find('\n', at)) != std::string::npos; at += 2)
    carriage.replace(at, 1, "\r\n");
  EXPECT_TRUE(import("d.ply", carriage));
}

TEST_F(ImportTraps, PolygonsThatTakeLongToTriangulate) {
  const std::string one_line = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + repeated("1 2 3 ", 40'000) + "\n";
  expect("a.obj", one_line, StatusCode::limit_exceeded, "120000 corners");
  const std::string continued =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 " + repeated("\\\n1 2 3 ", 40'000) + "\n";
  expect("b.obj", continued, StatusCode::limit_exceeded, "corners");
  const std::string many =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + repeated("f " + repeated("1 2 3 ", 1000) + "\n", 40);
  expect("c.obj", many, StatusCode::limit_exceeded, "3000 corners");
  EXPECT_TRUE(import("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf " + repeated("1 2 3 ", 300) + "\n"));
}

TEST_F(ImportTraps, VeryManyObjects) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "o a" + std::to_string(i) + "\nf 1 2 3\n";
  expect("a.obj", corners + objects, StatusCode::limit_exceeded, "100000 objects");
}

TEST_F(ImportTraps, LongLinesAreReadInLinearTime) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_TRUE(import("a.obj", "# " + std::string(4'000'000, 'x') + "\n" + corners));
  EXPECT_TRUE(import("b.obj", "o " + std::string(4'000'000, 'x') + "\n" + corners));
  EXPECT_TRUE(import("c.obj", corners + "v " + repeated("0 ", 1'000'000) + "\n"));
}

TEST_F(ImportTraps, OffCountsWithoutContent) {
  expect("a.off", "OFF\n50000000 1 0\n0 0 0\n", StatusCode::malformed_file, "50000000 vertices");
  expect("b.off", "OFF 3 2000000000 0\n" + kThree, StatusCode::malformed_file, "2000000000 faces");
  expect("c.off", "# x\n\nCOFF\n\n3000000000 3000000000 0\n0 0 0\n", StatusCode::malformed_file,
         "3000000000");
  expect("d.off", "nOFF 3\n3000000000 1 0\n0 0 0\n", StatusCode::malformed_file, "3000000000");
  EXPECT_TRUE(import("e.off", std::string("OFF\n3 1 0\n") + kThree + "3 0 1 2"));
  EXPECT_TRUE(import("f.off", test::kSquareOff));
}

TEST_F(ImportTraps, SmdSectionsWithoutEnd) {
  const std::string nodes = "version 1\nnodes\n0 \"a\" -1\n";
  const std::string skeleton = "skeleton\ntime 0\n0 0 0 0 0 0 0\n";
  const std::string triangle = "m\n0 0 0 0 0 0 1 0 0\n0 1 0 0 0 0 1 0 0\n0 0 1 0 0 0 1 0 0\n";
  expect("a.smd", nodes, StatusCode::malformed_file, "'nodes'");
  expect("b.smd", nodes + "end\n" + skeleton, StatusCode::malformed_file, "'skeleton'");
  expect("c.smd", nodes + "end\n" + skeleton + "end\ntriangles\n" + triangle,
         StatusCode::malformed_file, "'triangles'");
  std::string many = "version 1\nnodes\n";
  for (int i = 0; i < 20'000; ++i)
    many += std::to_string(i) + " \"a\" " + std::to_string(i - 1) + "\n";
  expect("d.smd", many + "end\n" + skeleton + "end\ntriangles\n" + triangle + "end\n",
         StatusCode::limit_exceeded, "4096 nodes");
  EXPECT_TRUE(
      import("e.smd", nodes + "end\n" + skeleton + "end\ntriangles\n" + triangle + "end\n"));
}

TEST_F(ImportTraps, DeepNesting) {
  expect("a.x", "xof 0303txt 0032\n" + repeated("Frame a {\n", 100'000), StatusCode::limit_exceeded,
         "levels");
  expect("a.fbx", "; FBX 7.3.0 project file\n" + repeated("A: {\n", 100'000),
         StatusCode::limit_exceeded, "levels");
  const std::string collada = R"(<?xml version="1.0"?><COLLADA version="1.4.1">)"
                              R"(<library_visual_scenes><visual_scene id="s">)";
  expect("a.dae", collada + repeated("<node>", 100'000), StatusCode::limit_exceeded, "levels");
  EXPECT_EQ(import("b.x", "xof 0303txt 0032\n" + repeated("Frame a {\n", 900) + repeated("}", 900))
                .text()
                .find("levels"),
            std::string_view::npos);
}

TEST_F(ImportTraps, XWeightsOfVerticesThatDoNotExist) {
  std::string text = test::kSkinnedX;
  EXPECT_TRUE(import("good.x", text));
  text.replace(text.find("2,3,4,5; 0.5"), 7, "2,3,4,6");
  expect("bad.x", text, StatusCode::index_out_of_range, "vertex 6");
}

TEST_F(ImportTraps, BracesInStringsAndCommentsDoNotCount) {
  const auto fbx = assimp_import::format_of("a.fbx");
  const auto x = assimp_import::format_of("a.x");
  const auto dae = assimp_import::format_of("a.dae");
  EXPECT_TRUE(assimp_import::check_text(*fbx, repeated("; {\nA: \"{{{\"\n", 5000), "a"));
  EXPECT_FALSE(assimp_import::check_text(*fbx, repeated("A: {\n", 5000), "a"));
  EXPECT_TRUE(assimp_import::check_text(*x, repeated("// {\n# {\n\"{\"; a/b;\n", 5000), "a"));
  EXPECT_FALSE(assimp_import::check_text(*x, repeated("a; {\n", 5000), "a"));
  EXPECT_TRUE(assimp_import::check_text(
      *dae, repeated("<!-- <a> --><![CDATA[<a>]]><?a <b>?><a b='>'/><a b=\"/>\"></a>", 5000), "a"));
  EXPECT_FALSE(assimp_import::check_text(*dae, repeated("<a b='/>'>", 5000), "a"));
}

/// No check refuses a model that people use.
TEST_F(ImportTraps, RealModelsPass) {
  LoadOptions options;
  options.import_seconds = 60;
  std::vector<std::filesystem::path> files;
  for (const auto& folder : {test::shared_models() / "rigged", test::shared_models() / "static"})
    if (!test::shared_models().empty())
      for (const auto& file :
           test::files_below(folder, {".ply", ".obj", ".off", ".x", ".dae", ".fbx"}))
        files.push_back(file);
  for (const auto& file : files) {
    const auto imported = contained_import::import_as_glb(file, options);
    EXPECT_TRUE(imported) << file << imported.error().text();
  }
}

/// Every text cut off at any place ends in a model or a status.
TEST_F(ImportTraps, TruncatedTexts) {
  const struct {
    const char* name;
    std::string content;
  } texts[] = {{"a.ply", test::kTornPly},
               {"a.off", test::kSquareOff},
               {"a.obj", test::kSquareObj},
               {"a.x", test::kSkinnedX},
               {"a.dae", test::kSixBoneCollada}};
  for (const auto& [name, content] : texts)
    for (std::size_t length = 1; length < content.size(); length += 64)
      EXPECT_NE(import(name, content.substr(0, length)).code(), StatusCode::internal_error)
          << name << " " << length;
}

}  // namespace
}  // namespace sunder
