// Holds the sizes that keep the house readable: how many headers are installed, how many files
// stand at a module's root, how long a function is and how many parameters it has.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "architecture/function_scan.h"
#include "architecture/source_tree.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

/// Headers of the runtime, all in <sunder/sunder.h>, and those of the validation for pipelines.
constexpr std::size_t kMostInstalledHeaders = 36;
constexpr std::size_t kMostPipelineHeaders = 4;
constexpr std::size_t kMostFilesAtRoot = 13;

constexpr std::size_t kMostLines = 60;
constexpr std::size_t kMostParameters = 8;

/// Files of vector kernels, whose functions take their registers as parameters.
const std::set<std::string> kVectorKernels = {"skinning/kernel-inl.h"};

/// Functions above the limit and their lines today: they may become shorter, not longer.
const std::map<std::string, std::size_t> kLongFunctions = {};

std::size_t most_lines_of(const std::string& function) {
  const auto known = kLongFunctions.find(function);
  return known == kLongFunctions.end() ? kMostLines : known->second;
}

std::size_t sources_at_root(const fs::path& folder) {
  std::size_t count = 0;
  for (const fs::path& file : source_files(folder))
    if (file.parent_path() == folder) ++count;
  return count;
}

/// One line per function of a folder that is above a limit.
std::vector<std::string> oversized_functions(const fs::path& root, const std::string& folder) {
  std::vector<std::string> found;
  for (const fs::path& path : source_files(root / folder)) {
    const std::string file = name_below(root, path);
    if (kVectorKernels.contains(file)) continue;
    for (const ScannedFunction& function : scan_functions(text_of(path)))
      if (function.lines > most_lines_of(function.name) || function.parameters > kMostParameters)
        found.push_back(file + ":" + std::to_string(function.line) + ": " + function.name +
                        " has " + std::to_string(function.lines) + " lines and " +
                        std::to_string(function.parameters) + " parameters");
  }
  return found;
}

TEST(SizeLimits, few_headers_are_installed) {
  const fs::path include = fs::path(SUNDER_SOURCE_DIR) / "include";
  const std::size_t of_pipelines = source_files(include / "sunder/validation").size();
  EXPECT_GT(of_pipelines, 0u);
  EXPECT_LE(of_pipelines, kMostPipelineHeaders);
  const std::size_t of_runtime = source_files(include).size() - of_pipelines;
  EXPECT_GT(of_runtime, 0u);
  EXPECT_LE(of_runtime, kMostInstalledHeaders);
}

TEST(SizeLimits, few_files_stand_at_the_roots_of_large_modules) {
  for (const char* const module : {"tear", "particles"}) {
    const std::size_t count = sources_at_root(fs::path(SUNDER_SOURCE_DIR) / module);
    EXPECT_GT(count, 0u) << module;
    EXPECT_LE(count, kMostFilesAtRoot) << module;
  }
}

TEST(SizeLimits, functions_are_short_and_take_few_parameters) {
  for (const char* const folder : {"core", "include", "io", "operation", "particles", "samples",
                                   "scene", "skinning", "tear", "tools", "validation", "weights"})
    EXPECT_THAT(oversized_functions(SUNDER_SOURCE_DIR, folder), IsEmpty());
}

TEST(FunctionScan, counts_lines_and_parameters) {
  const auto functions = scan_functions(R"(namespace a {
struct S {
  int method(int x, std::map<int, int> y) const {
    return x;
  }
  int data = 3;
};
template <class T>
[[nodiscard]] bool S::long_name(const T& a,
                                std::function<void(int, int)> b, int c = f(1, 2)) {
  if (a) {
    b(1, 2);
  }
  return true;  // }
}
void empty() {
  text("} {");
}
bool operator()(int a) {
  return a;
}
constexpr int kTable[] = {
    1, 2};
})");
  ASSERT_EQ(functions.size(), 4u);
  EXPECT_EQ(functions[0].name, "method");
  EXPECT_EQ(functions[0].lines, 3u);
  EXPECT_EQ(functions[0].parameters, 2u);
  EXPECT_EQ(functions[1].name, "S::long_name");
  EXPECT_EQ(functions[1].line, 9u);
  EXPECT_EQ(functions[1].lines, 7u);
  EXPECT_EQ(functions[1].parameters, 3u);
  EXPECT_EQ(functions[2].parameters, 0u);
  EXPECT_EQ(functions[3].parameters, 1u);
}

}  // namespace
}  // namespace sunder::test
