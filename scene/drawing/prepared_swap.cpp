#include "scene/drawing/prepared_swap.h"

#include <algorithm>
#include <new>
#include <utility>

namespace sunder::scene {

void PreparedSwap::prepare(const TornModel& replica,
                           std::span<const ChangeRecord> changes) noexcept {
  try {
    if (fork_) has_followed_ = static_cast<bool>(fork_->follow(replica, changes));
    prepare_tails(replica, changes);
  } catch (const std::bad_alloc&) {
    // The frame does without what is not there.
  }
}

void PreparedSwap::prepare_tails(const TornModel& replica, std::span<const ChangeRecord> changes) {
  const auto is_changed = [&](Index mesh) {
    return std::ranges::any_of(changes, [&](const ChangeRecord& change) {
      return std::ranges::any_of(change.meshes,
                                 [&](const MeshChange& of) { return of.mesh == mesh; });
    });
  };
  for (Index m = 0; m < meshes_.size(); ++m) {
    const Mesh& mesh = replica.character().meshes[m];
    const Index source_count = asset_->character()->meshes[m].vertex_count();
    if (!meshes_[m].poses_vertices || mesh.vertex_count() == source_count || !is_changed(m))
      continue;
    Result<PreparedTail> tail =
        PreparedTail::create(meshes_[m], source_count, mesh, replica.influence_positions(m));
    if (tail) tails_.push_back({m, std::move(*tail)});
  }
}

bool PreparedSwap::give(ParticleSet& particles, const TornModel& model) {
  return has_followed_ && fork_->take(particles, model);
}

void PreparedSwap::give(std::span<InstanceMesh> meshes) noexcept {
  for (OfMesh& of : tails_) meshes[of.mesh].adopt(std::move(of.tail));
  tails_.clear();
}

}  // namespace sunder::scene
