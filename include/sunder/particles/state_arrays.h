#pragma once

#include <cstdint>
#include <vector>

namespace sunder {

/// The recorded state of a ParticleSet or a SoftBody: plain numbers, to be written to a file array
/// by array. Their meaning is private and may change with `version`.
struct StateArrays {
  std::uint32_t version = 0;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint64_t> numbers;
  std::vector<float> floats;
  std::vector<double> doubles;

  bool operator==(const StateArrays&) const = default;
};

}  // namespace sunder
