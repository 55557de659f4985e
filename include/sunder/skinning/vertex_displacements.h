#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cstdint>

namespace sunder {

/// What moves a point beside its bones: a row of a vertex buffer. Weights are >= 0 and sum to one, or are all 0 for a point that
/// nothing moves.
struct ParticleInfluences {
  std::array<std::uint32_t, 4> particles = {};
  std::array<float, 4> weights = {};  ///< Descending; 0 where there are fewer particles.

  bool operator==(const ParticleInfluences&) const = default;
};

}  // namespace sunder
