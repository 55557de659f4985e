#pragma once

#include "bench/tear/repeated_operation.h"

namespace sunder::bench {

/// Lower bound for a tear: reads once the crossed faces, three vertices each with all attributes
/// and weights, at random places in arrays of the model's size, and writes once the new vertices,
/// two per face, and triangles.
class TouchBaseline {
 public:
  explicit TouchBaseline(const Scene& scene);

  /// @return seconds.
  double run(Caches caches = Caches::warm);

 private:
  void touch();

  Mesh mesh_;
  std::vector<std::uint32_t> faces_;
  std::uint32_t vertex_count_, triangle_count_;
};

}  // namespace sunder::bench
