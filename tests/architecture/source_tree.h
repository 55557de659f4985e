#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::test {

struct Include {
  std::string path;
  bool quoted = false;
};

/// The includes of a file; those in `//` comments do not count.
std::vector<Include> includes_of(const std::filesystem::path& file);

/// All .h and .cpp files below a folder, sorted; none if there is no such folder.
std::vector<std::filesystem::path> source_files(const std::filesystem::path& folder);

/// The text of a file; empty if it cannot be read.
std::string text_of(const std::filesystem::path& file);

/// `path` relative to `root`, with forward slashes.
std::string name_below(const std::filesystem::path& root, const std::filesystem::path& path);

/// A tree of one file in a temporary folder, which is removed with this object.
class FixtureTree {
 public:
  FixtureTree(const std::string& file, const std::string& content);
  ~FixtureTree();
  FixtureTree(const FixtureTree&) = delete;
  FixtureTree& operator=(const FixtureTree&) = delete;
  [[nodiscard]] const std::filesystem::path& root() const { return root_; }

 private:
  std::filesystem::path root_;
};

}  // namespace sunder::test
