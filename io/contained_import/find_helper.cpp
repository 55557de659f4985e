#include "io/contained_import/find_helper.h"

#include <algorithm>
#include <dlfcn.h>
#include <string>
#include <sys/auxv.h>
#include <system_error>
#include <utility>
#include <vector>

namespace sunder::contained_import {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "sunder-import";

/// A folder that holds this code, and the folder of its kind in an installation: "lib", "bin".
struct OwnFolder {
  fs::path folder;
  fs::path kind;
};

/// The file of the shared library that contains this code; empty if the program itself does. The
/// name that dladdr() gives for a program is what its caller called it, which need not be its path.
fs::path own_library() {
  Dl_info code{}, program{};
  if (dladdr(reinterpret_cast<const void*>(&own_library), &code) == 0 ||
      code.dli_fname == nullptr ||
      dladdr(reinterpret_cast<const void*>(getauxval(AT_PHDR)), &program) == 0 ||
      code.dli_fbase == program.dli_fbase)
    return {};
  fs::path library = code.dli_fname;
  // A relative one was meant for the folder that was current when the library was loaded.
  return library.is_absolute() ? library : fs::path();
}

/// Folders of the shared library that contains this code, and of the program.
std::vector<OwnFolder> own_folders() {
  std::vector<OwnFolder> folders;
  const auto add = [&](const fs::path& file, const char* kind) {
    std::error_code error;
    const fs::path whole = fs::canonical(file, error);
    if (!error) folders.push_back({whole.parent_path(), kind});
  };
  if (const fs::path library = own_library(); !library.empty()) add(library, SUNDER_LIBRARY_FOLDER);
  add("/proc/self/exe", SUNDER_PROGRAM_FOLDER);
  return folders;
}

/// The root of the installation: "/usr" for /usr/lib/x86_64-linux-gnu, if libraries are installed
/// in lib/x86_64-linux-gnu. Empty for a folder that has another name.
fs::path installation_of(const OwnFolder& own) {
  fs::path root = own.folder;
  const fs::path kind = own.kind.lexically_normal();
  if (kind.empty() || kind.is_absolute()) return {};
  for (auto part = kind.end(); part != kind.begin(); root = root.parent_path())
    if (root.filename() != *--part) return {};
  return root;
}

/// An installed library does not use the build tree, in which others may be able to write.
bool is_in_build_tree(const OwnFolder& own) {
  std::error_code error;
  const fs::path tree = fs::canonical(SUNDER_BUILD_FOLDER, error);
  return !error &&
         std::mismatch(tree.begin(), tree.end(), own.folder.begin(), own.folder.end()).first ==
             tree.end();
}

std::vector<fs::path> places_of(const std::vector<OwnFolder>& folders) {
  std::vector<fs::path> places;
  for (const OwnFolder& own : folders) {
    places.push_back(own.folder / kName);
    if (const fs::path root = installation_of(own); !root.empty())
      places.push_back((root / SUNDER_HELPER_FOLDER / kName).lexically_normal());
  }
  if (std::any_of(folders.begin(), folders.end(), is_in_build_tree))
    places.emplace_back(SUNDER_BUILT_HELPER);
  places.emplace_back(SUNDER_INSTALLED_HELPER);
  return places;
}

}  // namespace

Result<OwnProgram> find_helper(const fs::path& named) {
  if (!named.empty()) {
    Result<OwnProgram> helper = open_own_program(named);
    if (helper || helper.error().code() == StatusCode::limit_exceeded) return helper;
    return Status::failure(helper.error().code(), kNone, "LoadOptions::import_helper: %s",
                           helper.error().text().data());
  }
  const std::vector<OwnFolder> folders = own_folders();
  Status refusal;
  for (const fs::path& place : places_of(folders)) {
    Result<OwnProgram> helper = open_own_program(place);
    if (helper || helper.error().code() == StatusCode::limit_exceeded) return helper;
    if (refusal && helper.error().code() != StatusCode::file_not_found) refusal = helper.error();
  }
  if (!refusal) return refusal;
  return Status::failure(StatusCode::file_not_found, kNone,
                         "no helper executable '%s' in %.100s, nor in %s of its installation: set "
                         "LoadOptions::import_helper",
                         kName,
                         folders.empty() ? "the program's folder" : folders.back().folder.c_str(),
                         SUNDER_HELPER_FOLDER);
}

}  // namespace sunder::contained_import
