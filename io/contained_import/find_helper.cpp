#include "io/contained_import/find_helper.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace sunder::contained_import {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "sunder-import";

bool is_executable(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && access(file.c_str(), X_OK) == 0;
}

/// Folders of the file that contains this code, which is the library or the program that links it,
/// and of the program.
std::vector<fs::path> own_folders() {
  std::vector<fs::path> folders;
  std::error_code error;
  Dl_info about{};
  if (dladdr(reinterpret_cast<const void*>(&own_folders), &about) != 0 &&
      about.dli_fname != nullptr)
    if (fs::path library = fs::canonical(about.dli_fname, error); !error)
      folders.push_back(library.parent_path());
  if (fs::path program = fs::canonical("/proc/self/exe", error);
      !error && std::find(folders.begin(), folders.end(), program.parent_path()) == folders.end())
    folders.push_back(program.parent_path());
  return folders;
}

/// An installed library does not use the build tree, in which others may be able to write.
bool is_in_build_tree(const fs::path& folder) {
  std::error_code error;
  const fs::path tree = fs::canonical(SUNDER_BUILD_FOLDER, error);
  return !error &&
         std::mismatch(tree.begin(), tree.end(), folder.begin(), folder.end()).first == tree.end();
}

}  // namespace

Result<fs::path> find_helper(const fs::path& named) {
  if (!named.empty()) {
    if (is_executable(named)) return named;
    std::error_code error;
    return Status::failure(
        fs::exists(named, error) ? StatusCode::file_unreadable : StatusCode::file_not_found, kNone,
        "LoadOptions::import_helper '%.160s' is not an executable file", named.c_str());
  }
  const std::vector<fs::path> folders = own_folders();
  for (const fs::path& folder : folders)
    // Library folders may have two levels: lib/x86_64-linux-gnu.
    for (const char* const place : {".", "../libexec", "../bin", "../../libexec", "../../bin"})
      if (fs::path file = (folder / place / kName).lexically_normal(); is_executable(file))
        return file;
  if (std::any_of(folders.begin(), folders.end(), is_in_build_tree) &&
      is_executable(SUNDER_BUILT_HELPER))
    return fs::path(SUNDER_BUILT_HELPER);
  if (is_executable(SUNDER_INSTALLED_HELPER)) return fs::path(SUNDER_INSTALLED_HELPER);
  return Status::failure(
      StatusCode::file_not_found, kNone,
      "no helper executable '%s' in %.100s (or ../libexec, ../bin): set LoadOptions::import_helper",
      kName, folders.empty() ? "the program's folder" : folders.back().c_str());
}

}  // namespace sunder::contained_import
