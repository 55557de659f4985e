#include "support/models/shared_models.h"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace sunder::test {
namespace {

std::filesystem::path if_present(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_directory(folder, error) ? folder : std::filesystem::path();
}

}  // namespace

std::filesystem::path shared_models() {
  if (const char* const named = std::getenv("SUNDER_MODELS")) return if_present(named);
  return if_present(SUNDER_SHARED_MODELS);
}

std::filesystem::path own_data() { return SUNDER_TEST_DATA; }

std::filesystem::path assimp_models() { return if_present("/usr/share/assimp/models"); }

std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                               const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> files;
  if (folder.empty()) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && std::find(extensions.begin(), extensions.end(),
                                             entry.path().extension()) != extensions.end())
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::filesystem::path> rigged_models(const std::vector<std::string>& extensions) {
  auto files = files_below(own_data() / "rigged", extensions);
  if (const auto shared = shared_models(); !shared.empty())
    for (const auto& folder : {shared / "rigged", if_present(shared.parent_path() / "strangers")})
      for (const auto& file : files_below(folder, extensions)) files.push_back(file);
  return files;
}

std::vector<std::filesystem::path> rigged_gltf_models() { return rigged_models({".glb", ".gltf"}); }

}  // namespace sunder::test
