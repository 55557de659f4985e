#pragma once

#include <sunder/skinning/vertex_arrays.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "support/machine/random.h"

namespace sunder::test {

inline Vec3f random_vector(Random& random, double size) {
  const double length = random.uniform(0, size);
  return (length * random.direction()).cast<float>();
}

inline Vec4f with_zero(const Vec3f& u) { return {u.x(), u.y(), u.z(), 0.0f}; }

/// The data of a VertexDisplacements.
struct Soft {
  std::vector<std::uint32_t> rows;
  std::vector<ParticleInfluences> influences;
  std::vector<Vec4f> displacements;
  std::vector<IndexRange> moved;
  std::vector<ParticleGradients> gradients;
  std::vector<Mat3f> matrices;

  [[nodiscard]] VertexDisplacements view(bool with_gradients = true) const {
    VertexDisplacements view = {rows, influences, displacements, moved, {}, {}};
    if (with_gradients) view.gradients = gradients, view.model_from_gradient = matrices;
    return view;
  }

  void displace(Random& random) {
    for (Vec4f& u : displacements) u = with_zero(random_vector(random, 0.1));
    for (Mat3f& matrix : matrices)
      for (int e = 0; e < 9; ++e) matrix.data()[e] = static_cast<float>(random.uniform(-1, 1));
  }

  /// Random vertices: none, one, all, or many ranges, some of which are adjacent or empty.
  void move_some(Random& random) {
    const auto count = static_cast<std::uint32_t>(rows.size());
    const std::uint32_t wanted = random.index(4);
    moved.clear();
    if (wanted == 0) return;
    if (wanted == 1) return moved.push_back({random.index(count), 1});
    if (wanted == 2) return moved.push_back({0, count});
    for (std::uint32_t v = random.index(20); v < count;) {
      const std::uint32_t length =
          std::min(count - v, random.index(3) == 0 ? random.index(500) : random.index(4));
      moved.push_back({v, length});
      v += length + (random.index(2) == 0 ? 0 : random.index(random.index(3) == 0 ? 3000 : 40));
    }
  }
};

/// Random rows, of none to four particles, and random vertices without a row.
inline Soft make_soft(Random& random, std::uint32_t vertices, std::uint32_t particles = 40) {
  Soft soft;
  soft.displacements.resize(particles);
  soft.matrices.resize(particles);
  for (std::uint32_t row = 0; row <= vertices * 3 / 4; ++row) {
    ParticleInfluences influences;
    ParticleGradients gradients;
    const std::uint32_t count = random.index(5);  // 0: not displaced
    double sum = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
      influences.particles[k] = random.index(particles);
      influences.weights[k] = static_cast<float>(random.uniform(0.1, 1));
      sum += influences.weights[k];
      gradients.particles[k] = random.index(particles);  // need not be those of the point
      gradients.of_weights[k] = random_vector(random, 3);
    }
    for (std::uint32_t k = 0; k < count; ++k)
      influences.weights[k] = static_cast<float>(influences.weights[k] / sum);
    std::sort(influences.weights.begin(), influences.weights.end(), std::greater<>());
    soft.influences.push_back(influences);
    soft.gradients.push_back(gradients);
  }
  for (std::uint32_t v = 0; v < vertices; ++v)
    soft.rows.push_back(random.index(5) == 0
                            ? kNone
                            : random.index(static_cast<std::uint32_t>(soft.influences.size())));
  soft.displace(random);
  return soft;
}

}  // namespace sunder::test
