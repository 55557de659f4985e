#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sunder::tools {

/// A file on the command line.
struct NamedFile {
  std::string option;  ///< "MODEL", "--report".
  std::filesystem::path file;
};

/// Whether two paths lead to one file: also by links, and also if it does not exist yet.
[[nodiscard]] bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// The first fault of outputs that share a file with each other or with an input. Empty if there is
/// none.
/// @param inputs  those that must not be overwritten.
/// @param advice  follows a fault with an input: "; --force allows it".
[[nodiscard]] std::string overwriting(const std::vector<NamedFile>& inputs,
                                      const std::vector<NamedFile>& outputs,
                                      const std::string& advice = {});

}  // namespace sunder::tools
