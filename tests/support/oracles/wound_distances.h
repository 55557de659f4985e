#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <vector>

namespace sunder::test {

/// Ends in bind space.
using BruteForceLip = std::array<Vec3d, 2>;

/// The lips of a mesh that the models of the tests have: make_sheet(), or closed bodies.
std::vector<BruteForceLip> brute_force_lips(const TornModel& model, std::uint32_t mesh);

/// Which operation made each lip, by lists of all lips after each operation.
class LipHistory {
 public:
  explicit LipHistory(const TornModel& model) { record(model); }
  /// To be called after each operation and undo.
  void record(const TornModel& model);
  [[nodiscard]] std::uint32_t operation_of(const BruteForceLip& lip) const;

 private:
  std::vector<std::vector<BruteForceLip>> lips_;  ///< Before each operation, and now.
};

/// The distance of each texel to the nearest lip, by brute force: Dijkstra's paths within the faces
/// of the torn surface, between `steps` places on each edge. Never shorter than the shortest path,
/// and hardly longer.
/// @return per texel, row by row; negative where its centre is in no face.
std::vector<double> brute_force_wound(const TornModel& model, std::uint32_t mesh,
                                      std::uint32_t width, std::uint32_t height,
                                      std::uint32_t steps = 8);

}  // namespace sunder::test
