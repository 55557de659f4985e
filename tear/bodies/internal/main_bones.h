#pragma once

#include <sunder/core/api.h>
#include <sunder/core/mesh.h>
#include <sunder/core/skin.h>

#include <vector>

namespace sunder::bodies {

/// main_bone() for many triangles, with sums that are allocated once.
class MainBones {
 public:
  /// @throws std::bad_alloc
  explicit MainBones(std::size_t slots) : sums_(slots, kNoSum), touched_(slots) {}

  /// @param weights  >= 0, of slots below the number that the constructor was told.
  [[nodiscard]] std::uint32_t of(const Triangle& triangle, const SkinWeights& weights,
                                 const Skin& skin) {
    float* const sums = sums_.data();
    std::uint32_t* const touched = touched_.data();
    std::size_t count = 0;
    for (const std::uint32_t vertex : triangle)
      for (const Influence& influence : weights.of(vertex)) {
        SUNDER_ASSERT(influence.slot < sums_.size() && influence.weight >= 0);
        const float sum = sums[influence.slot];
        const bool is_first = sum == kNoSum;
        sums[influence.slot] = is_first ? influence.weight : sum + influence.weight;
        if (is_first) touched[count++] = influence.slot;
      }
    Influence most{kNone, 0.0f};
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t slot = touched[i];
      const float sum = sums[slot];
      if (sum > most.weight || (sum == most.weight && slot < most.slot)) most = {slot, sum};
      sums[slot] = kNoSum;
    }
    return skin.bones[most.slot];
  }

 private:
  static constexpr float kNoSum = -1;
  std::vector<float> sums_;  ///< Per slot, of the triangle's vertices; kNoSum between calls.
  std::vector<std::uint32_t> touched_;  ///< Slots with a sum.
};

}  // namespace sunder::bodies
