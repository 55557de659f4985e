// Faults that loading repairs are repaired in the written file too, and so are faults in parts that
// loading does not look at: the Khronos validator finds no error, whatever the source was.

#include <gtest/gtest.h>

#include "io/faulty_documents.h"
#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;

/// The character with one triangle fewer, as if it was torn.
Character changed(const Character& character) {
  Character torn = character;
  Mesh& mesh = torn.meshes.back();
  mesh.triangles.pop_back();
  mesh.triangle_submesh.pop_back();
  return torn;
}

void expect_same_geometry(const Character& a, const Character& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
    EXPECT_EQ(a.meshes[i].normals, b.meshes[i].normals);
    EXPECT_EQ(a.meshes[i].triangles, b.meshes[i].triangles);
    EXPECT_EQ(a.meshes[i].weights, b.meshes[i].weights);
  }
  // A clip without a channel cannot be written.
  std::size_t clips = 0;
  for (const Clip& clip : a.clips) clips += clip.channels.empty() ? 0 : 1;
  EXPECT_EQ(clips, b.clips.size());
}

/// One name and report per file of the folder that has errors.
std::vector<std::string> files_with_errors(const fs::path& folder) {
  const auto reports = validate_glbs_of(folder);
  const auto files = files_below(folder, {".glb"});
  EXPECT_EQ(reports.size(), files.size());
  std::vector<std::string> faulty;
  for (std::size_t i = 0; i < std::min(reports.size(), files.size()); ++i)
    if (reports[i].errors != 0)
      faulty.push_back(files[i].filename().string() + ": " + reports[i].output);
  return faulty;
}

TEST(RepairedFiles, have_no_error_and_the_geometry_that_was_loaded) {
  const TemporaryFolder folder;
  for (const FaultyDocument& document : faulty_documents()) {
    SCOPED_TRACE(document.name);
    const auto loaded = document.builder.load();
    ASSERT_TRUE(loaded) << loaded.error().text();
    const fs::path file = folder.path() / (document.name + ".glb");
    ASSERT_TRUE(save_glb(file, *loaded->character, *loaded));
    const auto again = load_character(file, strict());
    ASSERT_TRUE(again) << again.error().text();
    expect_same_geometry(*loaded->character, *again->character);
    ASSERT_TRUE(save_glb(folder.path() / (document.name + "_torn.glb"), changed(*loaded->character),
                         *loaded));
  }
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
  EXPECT_EQ(files_with_errors(folder.path()), std::vector<std::string>());
}

TEST(RepairedFiles, are_stable) {
  const TemporaryFolder folder;
  for (const FaultyDocument& document : faulty_documents()) {
    SCOPED_TRACE(document.name);
    const auto loaded = document.builder.load();
    ASSERT_TRUE(loaded);
    const fs::path once = folder.path() / "once.glb", twice = folder.path() / "twice.glb";
    ASSERT_TRUE(save_glb(once, *loaded->character, *loaded));
    const auto again = load_character(once);
    ASSERT_TRUE(again);
    ASSERT_TRUE(save_glb(twice, *again->character, *again));
    EXPECT_EQ(read_bytes(once), read_bytes(twice)) << "what was repaired needs a repair again";
  }
}

/// Files that are there: all that can be loaded, as they are and torn.
TEST(RepairedFiles, of_available_models_have_no_error) {
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
  std::vector<fs::path> sources = rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"});
  const auto append = [&](const fs::path& folder, const std::vector<std::string>& extensions) {
    if (folder.empty() || !fs::exists(folder)) return;
    const auto found = files_below(folder, extensions);
    sources.insert(sources.end(), found.begin(), found.end());
  };
  if (!shared_models().empty()) {
    append(shared_models() / "bad", {".gltf", ".glb"});
    append(shared_models() / "static", {".glb", ".off"});
  }
  append(assimp_models(), {".glb", ".gltf"});
  const TemporaryFolder folder;
  std::size_t number = 0;
  for (const fs::path& source : sources) {
    const auto loaded = load_character(source);
    if (!loaded) continue;
    SCOPED_TRACE(source);
    const std::string name = std::to_string(10'000 + number++) + "_" + source.stem().string();
    ASSERT_TRUE(save_glb(folder.path() / (name + ".glb"), *loaded->character, *loaded));
    ASSERT_TRUE(
        save_glb(folder.path() / (name + "_torn.glb"), changed(*loaded->character), *loaded));
  }
  std::vector<std::string> faulty = files_with_errors(folder.path());
  // A missing image is a fault of the folder, not of the file; its reference stays.
  std::erase_if(faulty, [](const std::string& line) {
    return line.find("IO_ERROR") != std::string::npos &&
           line.find("\"errors\":1,") != std::string::npos;
  });
  EXPECT_EQ(faulty, std::vector<std::string>());
}

}  // namespace
}  // namespace sunder::test
