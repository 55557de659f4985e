#pragma once

#include <sunder/core/character.h>

#include <cstdint>
#include <vector>

namespace sunder::gltf {

/// A mesh's influences as stored in JOINTS_n and WEIGHTS_n: four per vertex and set. Unused entries
/// have slot 0 and weight 0.
template <class Weight>
struct InfluenceSets {
  std::vector<std::vector<std::uint32_t>> slots;  ///< One array of V x 4 entries per set.
  std::vector<std::vector<Weight>> weights;       ///< Likewise.
};

/// Influences per vertex of one JOINTS_n with its WEIGHTS_n.
inline constexpr std::uint32_t kInfluencesOfASet = 4;

/// The number of influences of the vertex that has the most.
[[nodiscard]] std::uint32_t most_influences(const SkinWeights& weights);
[[nodiscard]] std::uint32_t most_influences(const Character& character);

/// Prunes the vertices that have more than `maximum` influences (0: none) and, if Weight is an
/// integer, quantises the weights. Other vertices keep the order of their influences.
/// @param weights  of a valid character.
template <class Weight>
[[nodiscard]] InfluenceSets<Weight> make_influence_sets(const SkinWeights& weights,
                                                        std::uint32_t maximum);

extern template InfluenceSets<float> make_influence_sets(const SkinWeights&, std::uint32_t);
extern template InfluenceSets<std::uint16_t> make_influence_sets(const SkinWeights&, std::uint32_t);
extern template InfluenceSets<std::uint8_t> make_influence_sets(const SkinWeights&, std::uint32_t);

}  // namespace sunder::gltf
