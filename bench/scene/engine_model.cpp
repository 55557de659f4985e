#include "bench/scene/engine_model.h"

#include <vector>

#include "bench/harness/skinned_subdivision.h"
#include "bench/scene/scene_crowd.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kRings = 45, kSides = 70, kBones = 64;

/// Tangents along u, perpendicular to the normals.
void add_tangents(Mesh& mesh) {
  std::vector<Vec3f> sums(mesh.vertex_count(), Vec3f::Zero());
  const std::vector<Vec2f>& uvs = mesh.uv_sets[0];
  for (const Triangle& t : mesh.triangles) {
    const Vec3f along_a = mesh.positions[t[1]] - mesh.positions[t[0]],
                along_b = mesh.positions[t[2]] - mesh.positions[t[0]];
    const Vec2f a = uvs[t[1]] - uvs[t[0]], b = uvs[t[2]] - uvs[t[0]];
    const float twice_area = a.x() * b.y() - a.y() * b.x();
    const Vec3f along_u =
        (twice_area < 0 ? -1.0f : 1.0f) * Vec3f(b.y() * along_a - a.y() * along_b);
    for (const std::uint32_t vertex : t) sums[vertex] += along_u;
  }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3f normal = mesh.normals[v];
    const Vec3f flat = sums[v] - normal * normal.dot(sums[v]);
    const Vec3f unit = flat.norm() > 0 ? Vec3f(flat.normalized()) : Vec3f(normal.unitOrthogonal());
    mesh.tangents.emplace_back(unit.x(), unit.y(), unit.z(), 1.0f);
  }
}

}  // namespace

std::shared_ptr<const Character> make_engine_model(int divisions) {
  Character rig = test::make_tube(kRings, kSides, 2);
  test::rig_along(rig, kBones);
  auto character = std::make_shared<Character>(subdivide_skinned(rig, divisions));
  for (Mesh& mesh : character->meshes) add_tangents(mesh);
  character->clips = {swing_clip(kBones)};
  return character;
}

}  // namespace sunder::bench
