#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::test {

/// The folder of the shared test models (next to the checkout, or named by SUNDER_MODELS); empty if
/// it is absent.
std::filesystem::path shared_models();

/// Debian's assimp-testmodels; empty if the package is not installed.
std::filesystem::path assimp_models();

/// tests/data: our own models, which are part of the repository.
std::filesystem::path own_data();

/// All files below a folder with one of these extensions (".glb"), sorted.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                               const std::vector<std::string>& extensions);

/// The rigged models with one of these extensions: our own, then the shared ones and those of the
/// folder "strangers" next to them, if they are there. Never empty for ".glb".
std::vector<std::filesystem::path> rigged_models(const std::vector<std::string>& extensions);

/// Those in glTF and GLB.
std::vector<std::filesystem::path> rigged_gltf_models();

}  // namespace sunder::test

/// Skips a test that needs the shared models if they are absent.
#define SUNDER_SKIP_WITHOUT_SHARED_MODELS()    \
  if (::sunder::test::shared_models().empty()) \
  GTEST_SKIP() << "needs the folder ../shared/models next to the checkout, or SUNDER_MODELS"
