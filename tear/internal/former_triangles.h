#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <vector>

namespace sunder::tear {

/// A triangle of the surface as it was before an operation that changed it.
struct FormerTriangle {
  Index triangle = 0;
  std::array<Index, 3> points = {};
  Triangle vertices = {};
};

/// The triangles that an operation changed or made.
struct TriangleHistory {
  Index count = 0;  ///< Triangles before the operation, which made those beyond.
  std::vector<FormerTriangle> former;
};

/// The triangles before each operation that can be undone, the oldest first. O(operations + logged
/// changes). Unpacks the model. @throws std::bad_alloc
[[nodiscard]] SUNDER_API std::vector<TriangleHistory> triangles_before_operations(
    const TornModel& model);

}  // namespace sunder::tear
