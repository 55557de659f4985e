#include "io/gltf_write/influence_sets.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <span>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

bool write_weights(std::span<const Influence> kept, std::span<float> written) {
  std::transform(kept.begin(), kept.end(), written.begin(),
                 [](const Influence& influence) { return influence.weight; });
  return true;
}

template <class Integer>
bool write_weights(std::span<const Influence> kept, std::span<Integer> written) {
  return quantise_weights(kept, written);
}

}  // namespace

std::uint32_t most_influences(const SkinWeights& weights) {
  std::uint32_t most = 1;
  for (std::uint32_t v = 0; v < weights.vertex_count(); ++v)
    most = std::max(most, static_cast<std::uint32_t>(weights.of(v).size()));
  return most;
}

std::uint32_t most_influences(const Character& character) {
  std::uint32_t most = 0;
  for (const Mesh& mesh : character.meshes) most = std::max(most, most_influences(mesh.weights));
  return most;
}

template <class Weight>
InfluenceSets<Weight> make_influence_sets(const SkinWeights& weights, std::uint32_t maximum) {
  std::uint32_t most = most_influences(weights);
  if (maximum != 0) most = std::min(most, maximum);
  const std::size_t set_count = (most + 3) / 4, vertex_count = weights.vertex_count();
  InfluenceSets<Weight> sets;
  sets.slots.assign(set_count, std::vector<std::uint32_t>(vertex_count * 4, 0));
  sets.weights.assign(set_count, std::vector<Weight>(vertex_count * 4, Weight{0}));
  std::vector<Influence> influences;
  std::vector<Weight> written(most);
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    const auto all = weights.of(v);
    influences.assign(all.begin(), all.end());
    const std::size_t kept =
        prune_influences(influences, influences.size() > maximum ? maximum : 0);
    if (kept == 0 || !write_weights(std::span<const Influence>(influences).first(kept),
                                    std::span<Weight>(written).first(kept)))
      refuse(StatusCode::weights_not_normalized, v,
             "save_glb: vertex %u: its weights do not have a positive, finite sum", v);
    for (std::size_t i = 0; i < kept; ++i) {
      if (written[i] == Weight{0}) continue;  // The joint of a zero weight must be 0.
      sets.slots[i / 4][std::size_t{v} * 4 + i % 4] = influences[i].slot;
      sets.weights[i / 4][std::size_t{v} * 4 + i % 4] = written[i];
    }
  }
  return sets;
}

template InfluenceSets<float> make_influence_sets(const SkinWeights&, std::uint32_t);
template InfluenceSets<std::uint16_t> make_influence_sets(const SkinWeights&, std::uint32_t);
template InfluenceSets<std::uint8_t> make_influence_sets(const SkinWeights&, std::uint32_t);

}  // namespace sunder::gltf
