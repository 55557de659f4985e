#include "pipeline/validation/match/skin_difference.h"

namespace sunder::validation {

SkinDifferences difference_of(const Character& source, const Character& target,
                              const SurfaceMatches& matches, const DrivenSkins& skins) {
  SkinDifferences differences;
  differences.first.reserve(matches.matches.size() + 1);
  TermSum sum(source.skeleton.bones.size());
  const auto add = [&](double part, const Mesh& mesh, Index vertex,
                       const std::vector<std::vector<DrivenSlot>>& slots) {
    sum.add_point(mesh.positions[vertex].cast<double>(), mesh.weights.of(vertex), slots[mesh.skin],
                  part);
  };
  const auto add_match = [&](const SurfaceMatch& match) {
    const Mesh& of = source.meshes[match.mesh];
    for (std::size_t k = 0; k < 3; ++k)
      if (match.barycentric[k] > 0)
        add(-match.barycentric[k], of, of.triangles[match.triangle][k], skins.of_source);
  };
  for (Index m = 0; m < target.meshes.size(); ++m)
    for (Index v = 0; v < target.meshes[m].vertex_count(); ++v) {
      if (const SurfaceMatch& match = matches.of(m, v); match.is_accepted) {
        add(1.0, target.meshes[m], v, skins.of_target);
        add_match(match);
      }
      sum.finish(differences);
    }
  return differences;
}

}  // namespace sunder::validation
