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

/// The first fault of outputs that share a file: with an input, unless that is allowed, or with
/// each other. Empty if there is none.
[[nodiscard]] std::string overwriting(const std::vector<NamedFile>& inputs,
                                      const std::vector<NamedFile>& outputs,
                                      bool may_overwrite_inputs);

}  // namespace sunder::tools
