#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::test {

/// The distance of each texel to the nearest lip, by brute force: Dijkstra's paths within the faces
/// of the torn surface, between `steps` places on each edge. Never shorter than the shortest path,
/// and hardly longer.
/// @return per texel, row by row; negative where its centre is in no face.
std::vector<double> brute_force_wound(const TornModel& model, std::uint32_t mesh,
                                      std::uint32_t width, std::uint32_t height,
                                      std::uint32_t steps = 8);

}  // namespace sunder::test
