#pragma once

#include <sunder/core/index.h>

#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// The vertices of each mesh that displaced particles move, cached until other particles are
/// displaced.
class MovedVertices {
 public:
  /// @param key           grows when the displaced particles or their points change; not 0.
  /// @param is_displaced  per particle.
  /// @throws std::bad_alloc
  std::span<const IndexRange> of(const ParticleSet& set, const TornModel& model, Index mesh,
                                 std::uint64_t key, std::span<const std::uint8_t> is_displaced);

 private:
  struct OfMesh {
    std::uint64_t key = 0;
    std::vector<IndexRange> ranges;
  };
  std::vector<OfMesh> meshes_;
  std::vector<Index> vertices_;
};

}  // namespace sunder::particles
