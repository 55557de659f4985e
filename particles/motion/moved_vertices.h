#pragma once

#include "particles/clusters/structure.h"
#include "particles/internal/bits.h"

namespace sunder::particles {

/// The vertices of each mesh that displaced particles move. Kept from call to call: only points of
/// particles that became displaced or stopped, and points and vertices that operations changed, are
/// looked at again.
class MovedVertices {
 public:
  /// @param key           grows when the displaced particles or their points change; not 0.
  /// @param is_displaced  per particle.
  /// @throws std::bad_alloc
  std::span<const IndexRange> of(const Structure& structure, const TornModel& model, Index mesh,
                                 std::uint64_t key, std::span<const std::uint8_t> is_displaced);
  [[nodiscard]] std::size_t memory_bytes() const {
    std::size_t bytes = is_displaced_.capacity() + changed_.capacity() * sizeof(Index) +
                        points_.memory_bytes() + meshes_.capacity() * sizeof(OfMesh);
    for (const OfMesh& mesh : meshes_)
      bytes += mesh.is_moved.memory_bytes() + mesh.ranges.capacity() * sizeof(IndexRange);
    return bytes;
  }

 private:
  struct OfMesh {
    Bits is_moved;  ///< Per vertex.
    std::vector<IndexRange> ranges;
    bool is_listed = false;
  };

  [[nodiscard]] bool is_point_displaced(const ParticleInfluences& of) const;
  [[nodiscard]] std::size_t list_changed_particles(const Structure& structure,
                                                   std::span<const std::uint8_t> is_displaced);
  void renew_all(const Structure& structure, const TornModel& model);
  void renew_changed(const Structure& structure, const TornModel& model);
  void renew_point(const Structure& structure, const TornModel& model, Index point);
  void renew_vertex(const Structure& structure, const TornModel& model, Index mesh, Index vertex);
  void resize(const Structure& structure);

  std::vector<std::uint8_t> is_displaced_;  ///< Per particle, in the last update.
  std::vector<Index> changed_;              ///< Particles.
  Bits points_;                             ///< Whether a displaced particle moves a point.
  std::vector<OfMesh> meshes_;
  std::uint64_t key_ = 0;     ///< 0: nothing is known.
  bool is_untouched_ = true;  ///< Whether no update began yet, so that all bits are rightly 0.
  std::uint64_t points_read_ = 0, vertices_read_ = 0;  ///< Places in the journals.
};

}  // namespace sunder::particles
