#pragma once

#include <sunder/core/skin.h>

#include <cstdint>
#include <vector>

namespace sunder::gltf {

/// A mesh's influences as JOINTS_n and WEIGHTS_n hold them: four a vertex and set. What is not used
/// is slot 0 with weight 0.
template <class Weight>
struct InfluenceSets {
  std::vector<std::vector<std::uint32_t>> slots;  ///< One array of V x 4 a set.
  std::vector<std::vector<Weight>> weights;       ///< Likewise.
};

/// Prunes every vertex to `maximum` influences (0: none is dropped) and, where Weight is an
/// integer, quantises what is kept.
/// @param weights  of a character that was validated.
template <class Weight>
[[nodiscard]] InfluenceSets<Weight> make_influence_sets(const SkinWeights& weights,
                                                        std::uint32_t maximum);

extern template InfluenceSets<float> make_influence_sets(const SkinWeights&, std::uint32_t);
extern template InfluenceSets<std::uint16_t> make_influence_sets(const SkinWeights&, std::uint32_t);
extern template InfluenceSets<std::uint8_t> make_influence_sets(const SkinWeights&, std::uint32_t);

}  // namespace sunder::gltf
