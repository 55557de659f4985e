#pragma once

#include <array>
#include <filesystem>
#include <string>

namespace sunder::test {

/// Programs that merge equal vertices of a glTF, as users run them.
inline constexpr std::array<const char*, 3> kWeldingTools = {"gltf-transform", "gltfpack", "three"};
/// The same with their default settings, which also merge vertices that are only close: by 14-bit
/// positions, within 0.0001.
inline constexpr std::array<const char*, 2> kCoarseWeldingTools = {"gltfpack-coarse",
                                                                   "three-coarse"};

/// Whether node and all tools are installed.
bool has_welding_tools();

/// Runs one of these on a GLB. @return its error text; empty if it wrote `output`.
std::string weld_by_tool(const std::string& tool, const std::filesystem::path& input,
                         const std::filesystem::path& output);

}  // namespace sunder::test

/// Skips a test that needs the tools if they are absent.
#define SUNDER_SKIP_WITHOUT_WELDING_TOOLS() \
  if (!::sunder::test::has_welding_tools()) \
  GTEST_SKIP() << "needs node, gltf-transform, gltfpack and three: npm ci --prefix tests/npm"
