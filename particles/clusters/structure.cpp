#include "particles/clusters/structure.h"

#include <algorithm>

#include "particles/clusters/band.h"
#include "particles/clusters/gradients.h"
#include "particles/clusters/pair_changes.h"

namespace sunder::particles {

Structure::Structure()
    : pairs(std::make_unique<PairChanges>()), gradients(std::make_unique<Gradients>()) {}
Structure::~Structure() = default;

void Structure::make_room(std::size_t point_count) {
  points.make_room(point_count);
  scratch.make_room(point_count);
}

void Structure::prepare_for_tears(Index triangles) {
  tears.triangle_count = triangles;
  make_room(points.count() + 1);
  points.lip_points.resize(points.count());
  points.memberships_end = points.memberships.size();
  reserve_eighth(points.memberships, points.memberships_end + 1);
  for (std::vector<Index>& of_mesh : vertex_points.of_mesh)
    reserve_eighth(of_mesh, of_mesh.size() + 1);
}

void Structure::note_dirty_points() {
  journal.points.add(dirty);
  const std::size_t most = points.count() / 2 + 4096;
  journal.points.trim(most);
  journal.vertices.trim(most);
}

std::vector<Index> Structure::members_of(Index particle) const {
  std::vector<Index> found;
  for_each_candidate(particle, [&](Index point) {
    if (points.find(point, particle) != nullptr) found.push_back(point);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace sunder::particles
