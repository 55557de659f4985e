#pragma once

#include <cstdint>

namespace sunder::plan {

/// A number from 0 to below 1: SplitMix64 (Steele, Lea and Flood 2014).
inline double next_share(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace sunder::plan
