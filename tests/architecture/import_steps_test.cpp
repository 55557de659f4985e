// Steps of assimp that must never be asked for.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

/// It compares vertices of rigged meshes in more than linear time, and joins such as differ.
TEST(ImportSteps, assimp_is_never_asked_to_join_vertices) {
  const std::string flag = std::string("aiProcess_") + "JoinIdenticalVertices";
  const std::string presets = std::string("aiProcessPreset_");  // which contain it
  const std::filesystem::path root = SUNDER_SOURCE_DIR;
  std::size_t files = 0;
  for (const char* folder : {"io", "tools", "bench", "tests"})
    for (const std::filesystem::path& file : source_files(root / folder)) {
      if (file.filename() == "import_steps_test.cpp") continue;
      ++files;
      const std::string text = text_of(file);
      EXPECT_EQ(text.find(flag), std::string::npos) << file;
      EXPECT_EQ(text.find(presets), std::string::npos) << file;
    }
  EXPECT_GT(files, 100u);
}

}  // namespace
}  // namespace sunder::test
