#include "skinning/displace.h"

#include <array>
#include <cmath>

namespace sunder::skinning {
namespace {

// Products and sums are rounded one by one, in one order, as in the kernel, so that coincident
// vertices with equal displacements stay coincident. Four numbers are summed at once as Eigen
// arrays, because compilers vectorise loops over three numbers poorly.

using Four = Eigen::Array4f;
using FourOf = Eigen::Map<const Four>;

/// The rows of vertices. Pointers, because compilers assume that a store of a float changes a span.
class Rows {
 public:
  explicit Rows(const VertexDisplacements& of)
      : rows_(of.vertex_rows.data()),
        influences_(of.influences.data()),
        count_(of.influences.size()) {}

  /// The row of a vertex, or kNone if nothing displaces it.
  [[nodiscard]] std::uint32_t of(std::uint32_t vertex) const {
    const std::uint32_t row = rows_[vertex];
    return row < count_ && influences_[row].weights[0] > 0.0f ? row : kNone;
  }
  [[nodiscard]] const ParticleInfluences& influences(std::uint32_t row) const {
    return influences_[row];
  }

 private:
  const std::uint32_t* rows_;
  const ParticleInfluences* influences_;
  std::size_t count_;
};

/// The floats of a vertex.
float* floats_of(const StridedFloats<float>& array, std::uint32_t vertex) {
  return reinterpret_cast<float*>(reinterpret_cast<unsigned char*>(array.data) +
                                  array.stride * vertex);
}

float dot(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void displace_positions(const VertexDisplacements& displacements, StridedFloats<float> positions,
                        std::uint32_t first, std::uint32_t end) {
  const Rows rows(displacements);
  const Vec4f* const of = displacements.displacements.data();
  for (std::uint32_t v = first; v < end; ++v) {
    const std::uint32_t row = rows.of(v);
    if (row == kNone) continue;
    const ParticleInfluences& by = rows.influences(row);
    const Four sum =
        by.weights[0] * of[by.particles[0]].array() + by.weights[1] * of[by.particles[1]].array() +
        by.weights[2] * of[by.particles[2]].array() + by.weights[3] * of[by.particles[3]].array();
    float* p = floats_of(positions, v);
    for (int i = 0; i < 3; ++i) p[i] += sum[i];
  }
}

/// The weighted mean of the matrices of four particles: nine numbers, column by column.
void blend_matrices(const ParticleInfluences& by, const Mat3f* matrices, float* mean) {
  const float *a = matrices[by.particles[0]].data(), *b = matrices[by.particles[1]].data(),
              *c = matrices[by.particles[2]].data(), *d = matrices[by.particles[3]].data();
  const float wa = by.weights[0], wb = by.weights[1], wc = by.weights[2], wd = by.weights[3];
  Eigen::Map<Four> first(mean), second(mean + 4);
  first = wa * FourOf(a) + wb * FourOf(b) + wc * FourOf(c) + wd * FourOf(d);
  second = wa * FourOf(a + 4) + wb * FourOf(b + 4) + wc * FourOf(c + 4) + wd * FourOf(d + 4);
  mean[8] = wa * a[8] + wb * b[8] + wc * c[8] + wd * d[8];
}

/// Writes `turned` to `at`, scaled to the length of the vector there, or to unit length. A vector
/// without length is not written.
void write_turned(const float* turned, bool unit_length, float* at) {
  const auto square = [](const float* v) {  // in double the square of a float does not underflow
    return double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2];
  };
  const double wanted = unit_length ? 1.0 : square(at), found = square(turned);
  if (!(found > 0.0)) return;
  const double scale = std::sqrt(wanted / found);
  for (int i = 0; i < 3; ++i) at[i] = static_cast<float>(scale * turned[i]);
}

/// The linear map of the displaced surface around a vertex, column by column: I + sum_k U_k g_k^T,
/// where g_k is the stored gradient transformed by the mean of the particles' matrices.
void map_around(const ParticleInfluences& by, const ParticleGradients& stored, const Vec4f* of,
                const Mat3f* matrices, float* map) {
  float mean[9];
  blend_matrices(by, matrices, mean);
  for (int i = 0; i < 9; ++i) map[i] = i % 4 == 0 ? 1.0f : 0.0f;
  for (std::size_t k = 0; k < 4; ++k) {
    const float *s = stored.of_weights[k].data(), *u = of[by.particles[k]].data();
    for (int j = 0; j < 3; ++j) {
      const float g = mean[j] * s[0] + mean[3 + j] * s[1] + mean[6 + j] * s[2];
      for (int i = 0; i < 3; ++i) map[3 * j + i] += g * u[i];
    }
  }
}

void cross(const float* a, const float* b, float* product) {
  product[0] = a[1] * b[2] - a[2] * b[1];
  product[1] = a[2] * b[0] - a[0] * b[2];
  product[2] = a[0] * b[1] - a[1] * b[0];
}

/// The normal of a mapped surface, by the cofactors of the map: exact, however far the surface is
/// displaced.
void turn_normal(const float* map, bool unit_length, float* n) {
  float x[3], y[3], z[3], turned[3];
  cross(map + 3, map + 6, x);
  cross(map + 6, map, y);
  cross(map, map + 3, z);
  for (int i = 0; i < 3; ++i) turned[i] = n[0] * x[i] + n[1] * y[i] + n[2] * z[i];
  write_turned(turned, unit_length, n);
}

/// @param n  the turned normal, to which the tangent becomes orthogonal; or null.
void turn_tangent(const float* map, const float* n, bool unit_length, float* t) {
  float turned[3];
  for (int i = 0; i < 3; ++i) turned[i] = map[i] * t[0] + map[3 + i] * t[1] + map[6 + i] * t[2];
  const float square = n == nullptr ? 0.0f : dot(n, n);
  if (square > 0.0f) {
    const float part = dot(n, turned) / square;
    for (int i = 0; i < 3; ++i) turned[i] -= part * n[i];
  }
  write_turned(turned, unit_length, t);
}

void turn_directions(const VertexDisplacements& displacements, const VertexTarget& target,
                     std::uint32_t first, std::uint32_t end) {
  const Rows rows(displacements);
  const StridedFloats<float> normals = target.normals, tangents = target.tangents;
  for (std::uint32_t v = first; v < end; ++v) {
    const std::uint32_t row = rows.of(v);
    if (row == kNone) continue;
    float map[9];
    map_around(rows.influences(row), displacements.gradients[row],
               displacements.displacements.data(), displacements.model_from_gradient.data(), map);
    float* const n = normals.data == nullptr ? nullptr : floats_of(normals, v);
    if (n != nullptr) turn_normal(map, target.unit_length, n);
    if (tangents.data != nullptr) turn_tangent(map, n, target.unit_length, floats_of(tangents, v));
  }
}

}  // namespace

Status check_displacements(const VertexDisplacements& displacements, std::uint32_t vertex_count) {
  if (displacements.moved.empty()) return {};
  if (displacements.vertex_rows.size() != vertex_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "vertex_rows has %zu entries; the mesh has %u vertices",
                           displacements.vertex_rows.size(), vertex_count);
  if (!displacements.gradients.empty() &&
      displacements.gradients.size() != displacements.influences.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "gradients has %zu entries, influences has %zu",
                           displacements.gradients.size(), displacements.influences.size());
  if (!displacements.gradients.empty() &&
      displacements.model_from_gradient.size() != displacements.displacements.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "displacements has %zu entries, model_from_gradient has %zu",
                           displacements.displacements.size(),
                           displacements.model_from_gradient.size());
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < displacements.moved.size(); ++i) {
    const IndexRange& range = displacements.moved[i];
    const std::uint64_t next = std::uint64_t{range.first} + range.count;
    if (range.first < end || next > vertex_count)
      return Status::failure(StatusCode::index_out_of_range, static_cast<std::uint32_t>(i),
                             "moved vertices [%u, %llu): ranges must ascend (the previous one ends "
                             "at %llu), and the mesh has %u vertices",
                             range.first, static_cast<unsigned long long>(next),
                             static_cast<unsigned long long>(end), vertex_count);
    end = next;
  }
  return {};
}

void displace_vertices(const VertexDisplacements& displacements, const VertexTarget& target,
                       std::uint32_t first, std::uint32_t end) {
  displace_positions(displacements, target.positions, first, end);
  if (!displacements.gradients.empty() &&
      (target.normals.data != nullptr || target.tangents.data != nullptr))
    turn_directions(displacements, target, first, end);
}

}  // namespace sunder::skinning
