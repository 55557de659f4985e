#include "architecture/source_tree.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

namespace sunder::test {

namespace fs = std::filesystem;

std::vector<Include> includes_of(const fs::path& file) {
  std::vector<Include> includes;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::erase_if(line, [](unsigned char c) { return std::isspace(c) != 0; });
    if (!line.starts_with("#include")) continue;
    const std::size_t open = line.find_first_of("<\"");
    if (open == std::string::npos) continue;
    const bool quoted = line[open] == '"';
    const std::size_t close = line.find(quoted ? '"' : '>', open + 1);
    if (close != std::string::npos)
      includes.push_back({line.substr(open + 1, close - open - 1), quoted});
  }
  return includes;
}

std::vector<fs::path> source_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (auto entry = fs::recursive_directory_iterator(folder);
       entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->path().filename() == "node_modules") entry.disable_recursion_pending();
    const std::string extension = entry->path().extension().string();
    if (extension == ".h" || extension == ".cpp") files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string name_below(const fs::path& root, const fs::path& path) {
  return path.lexically_relative(root).generic_string();
}

FixtureTree::FixtureTree(const std::string& file, const std::string& content)
    : root_(fs::path(testing::TempDir()) /
            ("architecture_" +
             std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
  fs::remove_all(root_);
  fs::create_directories((root_ / file).parent_path());
  std::ofstream(root_ / file) << content << '\n';
}

FixtureTree::~FixtureTree() { fs::remove_all(root_); }

}  // namespace sunder::test
