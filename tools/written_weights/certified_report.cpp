#include "tools/written_weights/certified_report.h"

#include <map>

#include "tools/messages/printed.h"
#include "tools/written_weights/written_influences.h"

namespace sunder::tools {
namespace {

/// Number of vertices by their number of influences, over the meshes that were chosen.
std::map<std::size_t, std::uint64_t> histogram(const CertifiedWeights& weights,
                                               const Character& character) {
  std::map<std::size_t, std::uint64_t> counts;
  for (const CertifiedMesh& chosen : weights.meshes) {
    const SkinWeights& of = character.meshes[chosen.mesh].weights;
    for (std::uint32_t v = 0; v < of.vertex_count(); ++v) ++counts[of.of(v).size()];
  }
  return counts;
}

Json histogram_json(const std::map<std::size_t, std::uint64_t>& counts) {
  Json json = Json::object();
  for (const auto& [influences, vertices] : counts) json[std::to_string(influences)] = vertices;
  return json;
}

/// Sums over the meshes.
struct Totals {
  std::uint64_t vertices = 0, changed = 0, morphed = 0, uncertified = 0;
  std::uint64_t bytes_as_floats = 0, bytes = 0;

  explicit Totals(const CertifiedWeights& weights) {
    for (const CertifiedMesh& mesh : weights.meshes) {
      vertices += mesh.bound.size();
      changed += mesh.changed;
      morphed += mesh.morphed;
      uncertified += mesh.uncertified;
      bytes_as_floats += mesh.bytes_as_floats;
      bytes += mesh.bytes;
    }
  }
};

}  // namespace

Json certificate_json(const CertifiedWeights& weights, const Character& unpruned,
                      const MaximumError& wanted) {
  const Totals totals(weights);
  Json meshes = Json::array();
  for (const CertifiedMesh& mesh : weights.meshes)
    meshes.push_back({{"mesh", unpruned.meshes[mesh.mesh].name},
                      {"index", mesh.mesh},
                      {"format", weight_format_name(mesh.format)},
                      {"sets", mesh.sets},
                      {"vertices_changed", mesh.changed},
                      {"vertices_uncertified", mesh.uncertified}});
  return {{"maximum_error", wanted.metres},
          {"limits", wanted.limits},
          {"certified_maximum", weights.maximum},
          {"vertices", totals.vertices},
          {"vertices_changed", totals.changed},
          {"vertices_changed_with_morphs", totals.morphed},
          {"vertices_uncertified", totals.uncertified},
          {"influences", histogram_json(histogram(weights, weights.character))},
          {"influences_before", histogram_json(histogram(weights, unpruned))},
          {"bytes_as_floats", totals.bytes_as_floats},
          {"bytes_written", totals.bytes},
          {"bytes_saved", static_cast<std::int64_t>(totals.bytes_as_floats - totals.bytes)},
          {"meshes", std::move(meshes)}};
}

std::string certificate_line(const CertifiedWeights& weights, const MaximumError& wanted) {
  const Totals totals(weights);
  std::string line = printed(
      "max error %g m, limits %.80s: no pose moves a vertex by more than %.4g m; vertices by "
      "influences:",
      wanted.metres, wanted.limits.c_str(), weights.maximum);
  for (const auto& [influences, vertices] : histogram(weights, weights.character))
    line += " " + std::to_string(influences) + ": " + std::to_string(vertices) + ",";
  line.back() = ';';
  if (totals.uncertified > 0)
    line += " " + std::to_string(totals.uncertified) + " without certificate keep all as floats;";
  line += " joints and weights have " + std::to_string(totals.bytes) + " bytes, " +
          std::to_string(totals.bytes_as_floats) + " with all influences as floats";
  return line;
}

}  // namespace sunder::tools
