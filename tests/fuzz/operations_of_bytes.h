#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder::fuzz {

/// A small model and operations on it.
struct Trial {
  Character character;
  std::vector<Operation> operations;  ///< Tears, cuts and bores.
};

/// Any bytes make a trial, and most changes of a byte make one small change to it. Vertices,
/// blades, planes and axes lie on a grid of 1/16, so that they often meet exactly, or are off it by
/// as little as 1e-17.
///
///     head       bones (1-3), vertices (3-16), triangles (1-24): a byte each
///     vertices   x, y, z in 1/16, weight: 4 bytes each
///     triangles  3 bytes each
///     operations up to the end, at most 4
Trial trial_of(std::span<const std::uint8_t> bytes);

}  // namespace sunder::fuzz
