#include "support/machine/gltf_tools.h"

#include "support/machine/node_program.h"

namespace sunder::test {

bool has_welding_tools() {
  static const bool are_there =
      has_node_packages({"@gltf-transform/core", "@gltf-transform/functions", "gltfpack", "three"});
  return are_there;
}

std::string weld_by_tool(const std::string& tool, const std::filesystem::path& input,
                         const std::filesystem::path& output) {
  const auto run =
      run_node_program("weld.mjs", tool + " '" + input.string() + "' '" + output.string() + "'");
  if (!run) return "it could not be started";
  if (run->succeeded && std::filesystem::exists(output)) return {};
  return "it failed: " + run->output;
}

}  // namespace sunder::test
