#pragma once

#include <sunder/core/index.h>

#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// Which vertices of a mesh certain particles move, kept until it is asked with others.
class MovedVertices {
 public:
  /// @param key  grows when the particles or what they move change. @param is_displaced  one a particle.
  std::span<const IndexRange> of(const ParticleSet& set, const TornModel& model, Index mesh, std::uint64_t key,
                                 std::span<const std::uint8_t> is_displaced);

 private:
  struct OfMesh {
    std::uint64_t key = 0;
    std::vector<IndexRange> ranges;
  };
  std::vector<OfMesh> meshes_;
  std::vector<Index> vertices_;
};

}  // namespace sunder::particles
