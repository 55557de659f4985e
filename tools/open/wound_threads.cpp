#include "tools/open/wound_threads.h"

#include <cstddef>
#include <cstdint>

#include "tools/model/posed_model.h"
#include "tools/picture/sewn_threads.h"

namespace sunder::tools {
namespace {

constexpr double kStitchOfDiagonal = 0.006;  ///< How far a stitch reaches from a lip.

}  // namespace

WoundWalls make_wound_threads(const TornModel& torn, std::span<const ThreadLoad> loads,
                              const std::vector<DeformedMesh>& closed,
                              const std::vector<DeformedMesh>& open) {
  WoundWalls threads;
  threads.meshes.resize(closed.size());
  if (threads_of(torn).empty()) return threads;
  const double thickness = kStitchOfDiagonal * bounds_of(torn.character(), closed).size().norm();
  const std::vector<ThreadTube> tubes = thread_tubes(torn, open, loads, thickness),
                                closed_tubes = thread_tubes(torn, closed, loads, thickness);
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    const ThreadTube& tube = tubes[i];
    if (tube.places.empty() || closed_tubes[i].places.empty()) continue;
    const MeshVertex left = vertex_at(torn, tube.left), right = vertex_at(torn, tube.right);
    WoundWalls::OfMesh& of = threads.meshes[left.mesh];
    const auto first = static_cast<std::uint32_t>(of.vertices.size());
    for (std::size_t v = 0; v < tube.places.size(); ++v) {
      const bool is_right = v >= tube.places.size() / 2 && right.mesh == left.mesh;
      of.vertices.push_back({is_right ? right.vertex : left.vertex, closed_tubes[i].places[v],
                             tube.places[v], tube.normals[v], Vec2f::Zero(), 0});
    }
    for (Triangle triangle : tube.triangles()) {
      for (std::uint32_t& vertex : triangle) vertex += first;
      of.triangles.push_back(triangle);
    }
  }
  return threads;
}

}  // namespace sunder::tools
