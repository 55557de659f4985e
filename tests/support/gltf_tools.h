#pragma once

#include <array>
#include <filesystem>
#include <string>

namespace sunder::test {

/// Programs that merge equal vertices of a glTF, as users run them.
inline constexpr std::array<const char*, 3> kWeldingTools = {"gltf-transform", "gltfpack", "three"};
/// The same with their default settings, which merge also what is only near: by 14-bit positions,
/// within 0.0001.
inline constexpr std::array<const char*, 2> kCoarseWeldingTools = {"gltfpack-coarse",
                                                                   "three-coarse"};

/// Whether node and all tools are there.
bool has_welding_tools();

/// Runs one of these on a GLB. @return what it complained of; empty: it has written `output`.
std::string weld_by_tool(const std::string& tool, const std::filesystem::path& input,
                         const std::filesystem::path& output);

}  // namespace sunder::test

/// Ends a test that needs the tools where they are absent.
#define SUNDER_SKIP_WITHOUT_WELDING_TOOLS() \
  if (!::sunder::test::has_welding_tools()) \
  GTEST_SKIP() << "needs node, gltf-transform, gltfpack and three: npm ci --prefix tests/npm"
