#pragma once

#include <sunder/core/skin.h>
#include <sunder/weights/influences.h>

#include <string>
#include <vector>

#include "io/gltf_read/reading.h"

namespace sunder::gltf {

/// One JOINTS_n with its WEIGHTS_n: four of each per vertex.
struct InfluenceSet {
  std::vector<std::uint32_t> slots;
  std::vector<float> weights;
  WeightFormat format = WeightFormat::float32;
};

/// The sets side by side, as the file has them.
[[nodiscard]] StoredInfluences stored_influences(const std::vector<InfluenceSet>& sets,
                                                 std::uint32_t vertex_count, std::string place);

struct ReadWeights {
  SkinWeights weights;
  bool repaired = false;  ///< The influences differ from the file's.
};

/// Converts the file's sets to valid SkinWeights, and notes the repairs. Weights that are valid
/// keep their bits; influences keep the file's order.
[[nodiscard]] ReadWeights make_weights(const std::vector<InfluenceSet>& sets,
                                       std::uint32_t vertex_count, std::uint32_t slot_count,
                                       std::uint32_t root_slot, const std::string& place,
                                       Notes& notes);

}  // namespace sunder::gltf
