#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::test {

/// The folder of the shared test models (beside the checkout, or what SUNDER_MODELS names); empty where it is absent.
std::filesystem::path shared_models();

/// Debian's assimp-testmodels; empty where the package is not installed.
std::filesystem::path assimp_models();

/// All files below a folder with one of these extensions (".glb"), sorted.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder, const std::vector<std::string>& extensions);

/// The glTF and GLB files of shared_models()/rigged.
std::vector<std::filesystem::path> rigged_gltf_models();

}  // namespace sunder::test

/// Ends a test that needs the shared models where they are absent.
#define SUNDER_SKIP_WITHOUT_SHARED_MODELS()    \
  if (::sunder::test::shared_models().empty()) \
  GTEST_SKIP() << "needs the folder ../shared/models beside the checkout, or SUNDER_MODELS"
