#include <sunder/io/character_file.h>

#include <algorithm>
#include <cstring>
#include <dirent.h>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/assimp_text_models.h"
#include "io/contained_import/import_as_glb.h"
#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SUNDER_UNDER_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SUNDER_UNDER_SANITIZER 1
#endif
#endif

namespace sunder {
namespace {

#if defined(SUNDER_UNDER_SANITIZER)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

namespace fs = std::filesystem;
using contained_import::import_as_glb;
using contained_import::ImportedGlb;
using nlohmann::json;

/// JSON and binary buffer of an imported GLB.
struct Glb {
  explicit Glb(const ImportedGlb& imported) {
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, imported.glb.data() + 12, 4);
    const char* text = reinterpret_cast<const char*>(imported.glb.data()) + 20;
    document = json::parse(text, text + json_bytes);
    binary.assign(imported.glb.begin() + 28 + json_bytes, imported.glb.end());
  }
  template <class T>
  [[nodiscard]] std::vector<T> accessor(std::size_t index) const {
    const json& accessor = document["accessors"][index];
    const json& view = document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<T> values(view["byteLength"].get<std::size_t>() / sizeof(T));
    std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(T));
    return values;
  }
  [[nodiscard]] const json& primitive(std::size_t mesh = 0) const {
    return document["meshes"][mesh]["primitives"][0];
  }
  [[nodiscard]] std::vector<float> attribute(const char* name) const {
    return accessor<float>(primitive()["attributes"][name].get<std::size_t>());
  }

  json document;
  std::vector<std::byte> binary;
};

bool has_note(const LoadReport& report, LoadNote::Kind kind, const char* part) {
  for (const LoadNote& note : report.notes)
    if (note.kind == kind && note.text.find(part) != std::string::npos) return true;
  return false;
}

/// Child processes and descriptors that a call left open.
class LeavesNothingBehind {
 public:
  LeavesNothingBehind() : descriptors_(open_descriptors()) {}
  ~LeavesNothingBehind() {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child was not reaped";
    EXPECT_EQ(open_descriptors(), descriptors_);
  }

 private:
  static int open_descriptors() {
    int count = 0;
    DIR* const folder = opendir("/proc/self/fd");
    while (folder != nullptr && readdir(folder) != nullptr) ++count;
    if (folder != nullptr) closedir(folder);
    return count;
  }
  int descriptors_;
};

TEST(AssimpImport, ObjWithMaterialAndTextureCoordinates) {
  const test::TemporaryFolder folder;
  folder.write("square.mtl", std::string_view(test::kSquareMtl));
  const auto imported =
      import_as_glb(folder.write("square.obj", std::string_view(test::kSquareObj)), {});
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->report.format.rfind("OBJ by assimp 5.2", 0), 0u) << imported->report.format;
  EXPECT_EQ(imported->report.space, "file units, taken as metres; axes as in the file");

  const Glb glb(*imported);
  EXPECT_EQ(glb.accessor<std::uint16_t>(glb.primitive()["indices"].get<std::size_t>()).size(), 6u);
  EXPECT_EQ(glb.attribute("POSITION").size(), 12u);
  const std::vector<float> uv = glb.attribute("TEXCOORD_0");
  ASSERT_EQ(uv.size(), 8u);
  EXPECT_EQ(uv[2 * 2 + 1], 0.25f);  // v counts downward in glTF.
  const std::vector<float> normals = glb.attribute("NORMAL");
  for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_EQ(normals[i], i % 3 == 2 ? 1.0f : 0.0f);
  EXPECT_TRUE(has_note(imported->report, LoadNote::Kind::information, "no normals"));

  const json& material = glb.document["materials"][glb.primitive()["material"].get<std::size_t>()];
  EXPECT_EQ(material["name"], "red");
  EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"], json({0.5, 0.25, 0.125, 1.0}));
}

TEST(AssimpImport, OffKeepsItsVertices) {
  const test::TemporaryFolder folder;
  const auto imported =
      import_as_glb(folder.write("square.off", std::string_view(test::kSquareOff)), {});
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(Glb(*imported).attribute("POSITION").size(), 12u);
}

TEST(AssimpImport, LipsOfATornIndexedMeshStayApart) {
  const test::TemporaryFolder folder;
  const auto imported =
      import_as_glb(folder.write("torn.ply", std::string_view(test::kTornPly)), {});
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(Glb(*imported).attribute("POSITION").size(), 21u);
}

TEST(AssimpImport, XWithSkinAndAnimation) {
  const test::TemporaryFolder folder;
  const auto imported =
      import_as_glb(folder.write("strip.x", std::string_view(test::kSkinnedX)), {});
  ASSERT_TRUE(imported) << imported.error().text();
  const Glb glb(*imported);
  ASSERT_EQ(glb.document["skins"].size(), 1u);
  const json& skin = glb.document["skins"][0];
  ASSERT_EQ(skin["joints"].size(), 2u);
  EXPECT_EQ(glb.document["nodes"][skin["joints"][0].get<std::size_t>()]["name"], "Lower");
  EXPECT_EQ(glb.document["nodes"][skin["joints"][1].get<std::size_t>()]["name"], "Upper");

  ASSERT_EQ(glb.document["animations"].size(), 1u);
  const json& clip = glb.document["animations"][0];
  EXPECT_EQ(clip["name"], "Bend");
  for (const json& channel : clip["channels"]) {
    if (channel["target"]["path"] != "rotation") continue;
    const json& sampler = clip["samplers"][channel["sampler"].get<std::size_t>()];
    EXPECT_EQ(glb.accessor<float>(sampler["input"].get<std::size_t>()),
              (std::vector<float>{0.0f, 1.0f}));  // 10 ticks at 10 per second.
  }
}

TEST(AssimpImport, ColladaWithSixInfluencesUnitAndUpAxis) {
  const test::TemporaryFolder folder;
  const auto imported =
      import_as_glb(folder.write("sail.dae", std::string_view(test::kSixBoneCollada)), {});
  ASSERT_TRUE(imported) << imported.error().text();
  const Glb glb(*imported);
  const std::vector<float> first = glb.attribute("WEIGHTS_0"), second = glb.attribute("WEIGHTS_1");
  ASSERT_EQ(first.size(), second.size());
  double sum = 0.0;
  int used = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += static_cast<double>(first[i]) + static_cast<double>(second[i]);
    used += (first[i] > 0.0f ? 1 : 0) + (second[i] > 0.0f ? 1 : 0);
  }
  EXPECT_EQ(used, 6);
  EXPECT_NEAR(sum, 1.0, 6 * 2e-7);
  EXPECT_TRUE(has_note(imported->report, LoadNote::Kind::repaired, "off by up to 0.2"));

  // The root converts centimetres and z up; assimp_pose_test.cpp checks the whole chain in poses.
  EXPECT_EQ(imported->report.space, "metres, y up; unit and up axis of the file applied");

  LoadOptions strict;
  strict.strict = true;
  strict.import_place = ImportPlace::in_process;  // sanitizers cannot filter
  EXPECT_EQ(import_as_glb(folder.path() / "sail.dae", strict).error().code(),
            StatusCode::weights_not_normalized);
}

TEST(AssimpImport, ContentMustBeWhatTheNameSays) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(import_as_glb(folder.write("strip.fbx", std::string_view(test::kSkinnedX)), {})
                .error()
                .code(),
            StatusCode::malformed_file);
  EXPECT_EQ(import_as_glb(folder.write("strip.ply", std::string_view(test::kSkinnedX)), {})
                .error()
                .code(),
            StatusCode::malformed_file);
  EXPECT_FALSE(import_as_glb(folder.write("strip.dae", std::string_view(test::kSkinnedX)), {}));
  EXPECT_FALSE(import_as_glb(folder.write("strip.3ds", std::string_view(test::kSkinnedX)), {}));
}

TEST(AssimpImport, many_influences_sum_to_one_as_closely_as_few) {
  std::string model = test::kSixBoneCollada;
  model.replace(model.find(">0.2 1.0<"), 9, ">0.16666652 1.0<");  // six sum to 1 - 8.8e-7
  const test::TemporaryFolder folder;
  const auto imported = import_as_glb(folder.write("sail.dae", std::string_view(model)), {});
  ASSERT_TRUE(imported) << imported.error().text();
  const Glb glb(*imported);
  double sum = 0.0;
  for (const char* set : {"WEIGHTS_0", "WEIGHTS_1"}) {
    const std::vector<float> weights = glb.attribute(set);
    for (std::size_t i = 0; i < 4; ++i) sum += static_cast<double>(weights[i]);
  }
  EXPECT_NEAR(sum, 1.0, 6e-8);
}

TEST(AssimpImport, a_key_that_repeats_the_previous_one_is_not_noted) {
  const std::string once = "2; 1; 0;3;0.0,1.0,0.0;;;";
  for (const auto& [keys, is_noted] :
       {std::pair("2; 2; 0;3;0.0,1.0,0.0;;, 0;3;0.0,1.0,0.0;;;", false),
        std::pair("2; 2; 0;3;0.0,1.0,0.0;;, 0;3;0.0,2.0,0.0;;;", true)}) {
    std::string model = test::kSkinnedX;
    model.replace(model.find(once), once.size(), keys);
    const test::TemporaryFolder folder;
    const auto loaded = load_character(folder.write("a.x", std::string_view(model)));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(std::ranges::any_of(loaded->report.notes,
                                  [](const LoadNote& note) {
                                    return note.text.find("not later") != std::string::npos;
                                  }),
              is_noted);
  }
}

TEST(AssimpImport, RefusesWhatIsNotItsBusiness) {
  const test::TemporaryFolder folder;
  for (const char* name :
       {"a.glb", "a.gltf", "a.VRM", "a.unknown", "a", "a.txt", "a.blend", "a.ifc", "a.lwo"})
    EXPECT_EQ(import_as_glb(folder.write(name, std::string_view("x")), {}).error().code(),
              StatusCode::unsupported_format)
        << name;
  EXPECT_EQ(import_as_glb(folder.path() / "absent.fbx", {}).error().code(),
            StatusCode::file_not_found);
  fs::create_directory(folder.path() / "folder.fbx");
  for (const fs::path& of_models : {folder.path() / "folder.fbx", folder.path()}) {
    const Status error = import_as_glb(of_models, {}).error();
    EXPECT_EQ(error.code(), StatusCode::file_unreadable);
    EXPECT_THAT(error.text(), testing::HasSubstr("is a folder"));
  }
  EXPECT_EQ(
      import_as_glb(folder.write("points.obj", std::string_view("v 0 0 0\nv 1 0 0\np 1 2\n")), {})
          .error()
          .code(),
      StatusCode::empty_input);
}

TEST(AssimpImport, ReadsNothingOutsideTheModelsFolder) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "inside");
  folder.write("square.mtl", std::string_view(test::kSquareMtl));
  std::string model = test::kSquareObj;
  model.replace(model.find("square.mtl"), 10, "../square.mtl");
  EXPECT_EQ(
      import_as_glb(folder.write("inside/square.obj", std::string_view(model)), {}).error().code(),
      StatusCode::path_not_allowed);

  // A link that leads outside is refused like a path.
  fs::create_symlink(folder.path() / "square.mtl", folder.path() / "inside" / "square.mtl");
  EXPECT_EQ(import_as_glb(folder.write("inside/link.obj", std::string_view(test::kSquareObj)), {})
                .error()
                .code(),
            StatusCode::path_not_allowed);
}

TEST(AssimpImport, LimitsHold) {
  const LeavesNothingBehind check;
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("square.off", std::string_view(test::kSquareOff));
  LoadOptions options;
  options.maximum_bytes = 10;
  EXPECT_EQ(import_as_glb(file, options).error().code(), StatusCode::limit_exceeded);
  options.maximum_bytes = 100;  // The file is within the limit, the model is not.
  EXPECT_EQ(import_as_glb(file, options).error().code(), StatusCode::limit_exceeded);
  options = {};
  options.import_seconds = 1e-6;
  EXPECT_EQ(import_as_glb(file, options).error().code(), StatusCode::limit_exceeded);
  options.import_seconds = 0.0;
  EXPECT_EQ(import_as_glb(file, options).error().code(), StatusCode::invalid_argument);
}

TEST(AssimpImport, TheSameFileGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("sail.dae", std::string_view(test::kSixBoneCollada));
  EXPECT_EQ(import_as_glb(file, {})->glb, import_as_glb(file, {})->glb);
}

struct BadFile {
  const char* name;
  StatusCode code;
};

/// Does nothing if the shared models are absent.
void expect_bad_shared_files_end_in_a_status() {
  if (test::shared_models().empty()) return;
  for (const BadFile bad : {BadFile{"garbage.fbx", StatusCode::malformed_file},
                            BadFile{"empty.obj", StatusCode::empty_input},
                            BadFile{"face_oob.obj", StatusCode::malformed_file},
                            BadFile{"huge_counts.off", StatusCode::malformed_file},
                            BadFile{"empty_init_from.dae", StatusCode::malformed_file},
                            BadFile{"skinweights_oob.x", StatusCode::index_out_of_range}}) {
    // There is no memory limit there.
    if (kIsSanitized && bad.code == StatusCode::limit_exceeded) continue;
    const auto imported = import_as_glb(test::shared_models() / "bad" / bad.name, {});
    ASSERT_FALSE(imported) << bad.name;
    EXPECT_EQ(imported.error().code(), bad.code) << bad.name << ": " << imported.error().text();
    EXPECT_NE(imported.error().text().find(bad.name), std::string_view::npos)
        << imported.error().text();
  }
}

constexpr const char* kHugeMd5 =
    "MD5Version 10\ncommandline \"\"\nnumJoints 1\nnumMeshes 1\njoints {\n\"a\" -1 ( 0 0 0 ) ( 0 0 "
    "0 )\n}\nmesh {\nshader \"a\"\nnumverts 2000000000\nvert 0 ( 0 0 ) 0 1\nnumtris 1\ntri 0 0 0 "
    "0\nnumweights 1\nweight 0 0 1 ( 0 0 0 )\n}\n";

TEST(AssimpImport, BadTextsEndInAStatus) {
  const test::TemporaryFolder folder;
  const auto code_of = [&](const char* name, std::string_view content) {
    const auto imported = import_as_glb(folder.write(name, content), {});
    EXPECT_FALSE(imported) << name;
    if (imported) return StatusCode::ok;
    EXPECT_NE(imported.error().text().find(name), std::string_view::npos)
        << imported.error().text();
    return imported.error().code();
  };
  const LeavesNothingBehind check;
  EXPECT_EQ(code_of("empty.obj", ""), StatusCode::empty_input);
  EXPECT_EQ(code_of("face.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"),
            StatusCode::malformed_file);
  EXPECT_EQ(code_of("huge.off", "OFF\n3000000000 3000000000 0\n0 0 0\n"),
            StatusCode::malformed_file);
  if (!kIsSanitized) {  // which has no memory limit
    EXPECT_EQ(code_of("huge.md5mesh", kHugeMd5), StatusCode::limit_exceeded);
  }
  expect_bad_shared_files_end_in_a_status();
}

/// Checked by the glTF validator if it is installed.
TEST(AssimpImport, RiggedModelsBecomeValidGltf) {
  const test::TemporaryFolder folder;
  const std::vector<fs::path> files = test::rigged_models({".fbx", ".dae", ".x", ".b3d"});
  ASSERT_GE(files.size(), 2u);
  for (const fs::path& file : files) {
    const auto imported = import_as_glb(file, {});
    ASSERT_TRUE(imported) << file << imported.error().text();
    EXPECT_TRUE(
        has_note(imported->report, LoadNote::Kind::information, "reproduces the mesh within"))
        << file;
    EXPECT_NO_THROW(Glb{*imported}) << file;
    if (!test::has_gltf_validator()) continue;
    const auto report = test::validate_glb(folder.write("model.glb", imported->glb));
    EXPECT_EQ(report.errors, 0) << file << report.output;
  }
}

TEST(AssimpImport, FbxUnitAndAxesAreApplied) {
  if (test::assimp_models().empty()) GTEST_SKIP() << "needs Debian's assimp-testmodels";
  const auto imported = import_as_glb(test::assimp_models() / "FBX/embedded_ascii/box.FBX", {});
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->report.space, "metres, y up; converted from units of 100 cm, z up");
  const json root = Glb(*imported).document["nodes"][0];
  EXPECT_EQ(root["name"], "model_from_file");
  EXPECT_NEAR(root["rotation"][0].get<double>(), -0.70710678,
              1e-7);  // A quarter turn about x: z becomes y.
  EXPECT_FALSE(root.contains("scale"));
}

/// Every file of assimp's own collection, including broken ones, results in a valid GLB or in a
/// status.
TEST(AssimpImport, AssimpsOwnModels) {
  if (test::assimp_models().empty()) GTEST_SKIP() << "needs Debian's assimp-testmodels";
  const LeavesNothingBehind check;
  LoadOptions options;
  options.import_seconds = 30.0;
  int imported_files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(test::assimp_models())) {
    if (!entry.is_regular_file()) continue;
    const auto imported = import_as_glb(entry.path(), options);
    if (imported) {
      ++imported_files;
      EXPECT_NO_THROW(Glb{*imported}) << entry.path();
    } else {
      EXPECT_NE(imported.error().code(), StatusCode::internal_error)
          << entry.path() << imported.error().text();
    }
  }
  EXPECT_GT(imported_files, 60);
}

}  // namespace
}  // namespace sunder
