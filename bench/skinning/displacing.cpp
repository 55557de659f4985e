#include "bench/skinning/displacing.h"

#include <cstring>
#include <deque>

#include "bench/harness/measure.h"
#include "bench/skinning/posing_turns.h"
#include "support/models/random_displacements.h"

namespace sunder::bench {

Displacing measure_displacing(const SkinningScene& scene) {
  Mesh mesh = scene.mesh();
  mesh.tangents.assign(mesh.vertex_count(), Vec4f(1, 0, 0, 1));
  const auto skinned = SkinnedMesh::create(source_of(mesh), scene.character.skins[0].bones.size());
  test::Random random(1);
  test::Soft soft = test::make_soft(random, mesh.vertex_count(), 200);
  // A row and four particles for each vertex; neighbours share most of them.
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) soft.rows[v] = v;
  soft.influences.resize(mesh.vertex_count());
  soft.gradients.resize(mesh.vertex_count());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    for (std::uint32_t k = 0; k < 4; ++k) {
      soft.influences[v].particles[k] =
          static_cast<std::uint32_t>(190.0 * v / mesh.vertex_count()) + random.index(10);
      soft.influences[v].weights[k] = 0.25f;
      soft.gradients[v].particles[k] = soft.influences[v].particles[k];
      soft.gradients[v].of_weights[k] = test::random_vector(random, 3);
    }
  soft.moved = {{0, mesh.vertex_count()}};
  const VertexDisplacements displacements = soft.view();

  CrowdMember member(scene);
  std::vector<PosingCandidate> candidates;
  std::deque<PosedBuffer> buffers;
  for (int attributes = 1; attributes <= 3; ++attributes)
    for (const VertexDisplacements* displaced :
         {static_cast<const VertexDisplacements*>(nullptr), &displacements}) {
      VertexTarget target{member.vertices, {member.positions.data()}, {}, {}};
      if (attributes > 1) target.normals = {member.normals.data()};
      if (attributes > 2) target.tangents = {member.tangents.data()};
      PosedBuffer& buffer = buffers.emplace_back(target);
      candidates.push_back({"", [&skinned, &member, &buffer, displaced](std::size_t pose) {
                              (void)skinned->deform(member.palettes[pose], buffer, {}, displaced);
                            }});
    }
  measure_posing(candidates, member.vertices, 15);
  const auto added = [&](std::size_t attributes) {
    return median(candidates[2 * attributes + 1].ns_per_vertex) -
           median(candidates[2 * attributes].ns_per_vertex);
  };
  return {added(0), added(1), added(2)};
}

}  // namespace sunder::bench
