#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::test {

/// Whether node and the package are installed.
bool has_gltf_validator();

struct ValidatorReport {
  int errors = -1;     ///< -1: it could not be run.
  std::string output;  ///< JSON, with the first messages.
};

/// The result of the Khronos validator for a GLB.
ValidatorReport validate_glb(const std::filesystem::path& file);

/// The results for all GLBs of a folder, in the order of their names, by one run of the validator.
std::vector<ValidatorReport> validate_glbs_of(const std::filesystem::path& folder);

}  // namespace sunder::test

/// Skips a test that needs the validator if it is absent.
#define SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR() \
  if (!::sunder::test::has_gltf_validator()) \
  GTEST_SKIP() << "needs node and gltf-validator: npm ci --prefix tests/npm"
