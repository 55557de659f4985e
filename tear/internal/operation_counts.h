#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

namespace sunder::tear {

/// The sizes of a model before an operation.
struct OperationCounts {
  Index points = 0;
  std::vector<Index> vertices;  ///< Per mesh.
};

/// The counts before each operation that can be undone, the oldest first. O(operations x meshes);
/// of several meshes O(operations x appended vertices and triangles). Unpacks the model.
/// @throws std::bad_alloc
[[nodiscard]] SUNDER_API std::vector<OperationCounts> counts_before_operations(
    const TornModel& model);

}  // namespace sunder::tear
