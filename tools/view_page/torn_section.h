#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include <array>
#include <cstdint>
#include <vector>

#include "tools/page_parts/data_arrays.h"

namespace sunder::tools {

/// The traces of tearing in a model, found by comparing it with its source.
struct TornParts {
  /// Open edges that the source does not have; vertices of all meshes, back to back.
  std::vector<std::array<std::uint32_t, 2>> lips;
  /// Per vertex 0, or the number of the separated piece that it belongs to, from 1. Of the parts
  /// that were one in the source, all but the largest are pieces.
  std::vector<std::uint16_t> piece_of_vertex;
  std::uint32_t pieces = 0;
};

/// @return the failures of TornModel::create(). O(n log n + open edges of both), allocates.
[[nodiscard]] Result<TornParts> find_torn_parts(const Character& source, const Character& torn);

/// Adds them to the section of the torn model.
void add_torn_parts(const TornParts& parts, DataArrays& arrays, Json& section);

}  // namespace sunder::tools
