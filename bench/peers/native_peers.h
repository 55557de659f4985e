#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::bench {

// Baselines for our own code, compiled for this machine (-O3 -march=native) into a library that
// exports nothing else.

/// Naive skinning in Eigen: a 3 x 4 matrix blended from four influences, applied to a position and
/// a normal; packed arrays.
/// @param matrices  12 floats per slot, column by column.
[[gnu::visibility("default")]] void skin_by_eigen(std::size_t vertices, const float* positions,
                                                  const float* normals, const std::uint16_t* slots,
                                                  const float* weights, const float* matrices,
                                                  float* posed_positions, float* posed_normals);

enum class Stores { plain, around_caches };

/// Reads every vector of `in` and writes every vector of two arrays: the minimum for a program that
/// handles as many bytes. Arrays begin at cache lines; a remainder of less than a line is left out.
/// @param ahead  distance of prefetches in bytes; 0: no prefetches.
[[gnu::visibility("default")]] void touch(const float* in, std::size_t in_floats, float* out_a,
                                          float* out_b, std::size_t out_floats, Stores stores,
                                          std::size_t ahead);

}  // namespace sunder::bench
