#pragma once

#include <sunder/core/index.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace sunder::particles {

/// The point of each vertex.
struct VertexPoints {
  /// Per mesh and vertex: the point; kNone if no face uses the vertex.
  std::vector<std::vector<Index>> of_mesh;
  /// Vertices in which a surface touches itself have several points. Lists all points that they
  /// ever had.
  std::map<std::pair<Index, Index>, std::vector<Index>> shared;

  void share(Index mesh, Index vertex, Index point, Index other) {
    std::vector<Index>& points = shared[{mesh, vertex}];
    for (const Index each : {point, other})
      if (std::find(points.begin(), points.end(), each) == points.end()) points.push_back(each);
  }
};

}  // namespace sunder::particles
