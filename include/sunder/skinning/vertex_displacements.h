#pragma once

#include <sunder/core/math.h>
#include <sunder/core/range.h>

#include <array>
#include <cstdint>
#include <span>

namespace sunder {

/// What moves a point beside its bones: a row of a vertex buffer. Weights are >= 0 and sum to one, or are all 0 for a point that
/// nothing moves.
struct ParticleInfluences {
  std::array<std::uint32_t, 4> particles = {};
  std::array<float, 4> weights = {};  ///< Descending; 0 where there are fewer particles.

  bool operator==(const ParticleInfluences&) const = default;
};

/// How the four weights of a ParticleInfluences change along the surface.
struct ParticleGradients {
  /// In the surface's tangent plane, in the pose that they were taken in and its space; 1 / metre. 0 where the weight is.
  std::array<Vec3f, 4> of_weights = {Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero()};
};

/// What moves vertices beside their bones, this time: SkinnedMesh::deform() puts a vertex at p + sum_k w_k U_k, where the bones put
/// it at p. *Posed space* is that of posed vertices: of the model, or of the frame that BonePalette::set() was given.
///
/// With gradients, normals and tangents follow, exactly to first order in U: n - sum_k (n . U_k) g_k and t + sum_k (g_k . t) U_k,
/// at the lengths that the bones gave them, or unit length where the buffer wants it; the w of tangents is kept. g_k is the stored
/// gradient by the mean, by weights, of the particles' `model_from_gradient`.
struct VertexDisplacements {
  std::span<const std::uint32_t> vertex_rows;      ///< One a vertex: its row; kNone, or none of the rows: nothing displaces it.
  std::span<const ParticleInfluences> influences;  ///< Rows, e.g. one a surface point. Particles are unchecked, also of weights 0.
  std::span<const Vec4f> displacements;            ///< U, one a particle: x y z 0, posed space, metres, finite.
  std::span<const Range> moved;  ///< Vertices that are displaced: ascending, none twice. Others are where bones put them.
  std::span<const ParticleGradients> gradients;  ///< One a row; or empty: normals and tangents are as the bones turn them.
  std::span<const Mat3f> model_from_gradient;    ///< One a particle, where there are gradients: turns them into posed space.
};

}  // namespace sunder
