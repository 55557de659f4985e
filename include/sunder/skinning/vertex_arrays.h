#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>
#include <sunder/core/mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sunder {

/// An attribute of floats in someone's memory, packed or between other attributes. No data: the
/// attribute is not there.
template <class Float>
struct StridedFloats {
  Float* data = nullptr;
  std::size_t stride = 0;  ///< Bytes from one vertex to the next, a multiple of 4; 0: packed.
};

/// Influences as engines keep them: the same number of places a vertex; a place with weight 0 is
/// empty.
struct InfluenceArrays {
  std::size_t per_vertex = 0;                ///< Places a vertex.
  const std::uint16_t* slots = nullptr;      ///< V x per_vertex.
  std::size_t slot_stride = 0;               ///< Bytes from one vertex to the next; 0: packed.
  const float* weights = nullptr;            ///< V x per_vertex; or
  const std::uint16_t* weights16 = nullptr;  ///< the same as 65535ths.
  std::size_t weight_stride = 0;             ///< Bytes from one vertex to the next; 0: packed.
};

/// Vertices with a bind position of their own for each influence: p = sum_i M_i q_i follows a point
/// of a triangle exactly, in every pose, where q_i = sum_k beta_k w_ki [v_k; 1] for the triangle's
/// corners v_k. (The last component of q_i is the weight of influence i, which the weights of the
/// mesh hold.) Arrays other than `vertices` and `positions` are empty where there is nothing.
/// Source: Merry, Marais, Gain, Animation space, TOG 2006 [merry2006animation].
struct InfluencePositions {
  struct Deltas {
    std::vector<Vec3f> positions, normals, tangents;
  };

  std::vector<std::uint32_t> vertices;  ///< Ascending.
  std::vector<Vec3f> positions;  ///< One an influence of those vertices, back to back, in the order
                                 ///< of their weights.
  std::vector<Vec3f> normals;    ///< As `positions`: sum_k beta_k w_ki n_k.
  std::vector<Vec3f> tangents;   ///< As `positions`.
  std::vector<Deltas>
      morph_targets;  ///< One a morph target of the mesh: the same sums of its displacements.
};

/// What SkinnedMesh reads of a mesh, once.
struct VertexSource {
  std::uint32_t vertex_count = 0;        ///< V.
  StridedFloats<const float> positions;  ///< x y z.
  StridedFloats<const float> normals;    ///< x y z, unit length, or not there.
  StridedFloats<const float> tangents;   ///< x y z w, or not there.
  const SkinWeights* weights = nullptr;  ///< V; or
  InfluenceArrays influences;            ///< the same in arrays.
  std::span<const MorphTarget> morph_targets;
  std::uint32_t first_morph_weight = 0;               ///< Weight of target 0 in the pose.
  const InfluencePositions* per_influence = nullptr;  ///< Only beside `weights`.
};

/// A mesh as it is.
[[nodiscard]] inline VertexSource source_of(const Mesh& mesh) {
  VertexSource source;
  source.vertex_count = mesh.vertex_count();
  source.positions.data = mesh.positions.empty() ? nullptr : mesh.positions[0].data();
  source.normals.data = mesh.normals.empty() ? nullptr : mesh.normals[0].data();
  source.tangents.data = mesh.tangents.empty() ? nullptr : mesh.tangents[0].data();
  source.weights = &mesh.weights;
  source.morph_targets = mesh.morph_targets;
  source.first_morph_weight = mesh.first_morph_weight;
  return source;
}

/// Where posed vertices go. An attribute without data is not computed.
struct VertexTarget {
  std::uint32_t vertex_count = 0;
  StridedFloats<float> positions;  ///< x y z.
  StridedFloats<float> normals;    ///< x y z.
  StridedFloats<float> tangents;   ///< x y z w.
  /// Whether normals and tangents get unit length. Otherwise they keep the length that blending
  /// gives them, which is at most that of the largest scale: a shader that normalises them anyway
  /// need not pay twice.
  bool unit_length = false;
};

/// What moves a point beside its bones: a row of a vertex buffer. Weights are >= 0 and sum to one,
/// or are all 0 for a point that nothing moves.
struct ParticleInfluences {
  std::array<std::uint32_t, 4> particles = {};
  std::array<float, 4> weights = {};  ///< Descending; 0 where there are fewer particles.

  bool operator==(const ParticleInfluences&) const = default;
};

/// How the four weights of a ParticleInfluences change along the surface.
struct ParticleGradients {
  /// In the surface's tangent plane, in the pose that they were taken in and its space; 1 / metre.
  /// 0 where the weight is.
  std::array<Vec3f, 4> of_weights = {Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero()};
};

/// What moves vertices beside their bones, this time: SkinnedMesh::deform() puts a vertex at p +
/// sum_k w_k U_k, where the bones put it at p. *Posed space* is that of posed vertices: of the
/// model, or of the frame that BonePalette::set() was given.
///
/// With gradients, normals and tangents follow, exactly to first order in U: n - sum_k (n . U_k)
/// g_k and t + sum_k (g_k . t) U_k, at the lengths that the bones gave them, or unit length where
/// the buffer wants it; the w of tangents is kept. g_k is the stored gradient by the mean, by
/// weights, of the particles' `model_from_gradient`.
struct VertexDisplacements {
  std::span<const std::uint32_t>
      vertex_rows;  ///< One a vertex: its row; kNone, or none of the rows: nothing displaces it.
  std::span<const ParticleInfluences>
      influences;  ///< Rows, e.g. one a surface point. Particles are unchecked, also of weights 0.
  std::span<const Vec4f>
      displacements;                  ///< U, one a particle: x y z 0, posed space, metres, finite.
  std::span<const IndexRange> moved;  ///< Vertices that are displaced: ascending, none twice.
                                      ///< Others are where bones put them.
  std::span<const ParticleGradients>
      gradients;  ///< One a row; or empty: normals and tangents are as the bones turn them.
  std::span<const Mat3f> model_from_gradient;  ///< One a particle, where there are gradients: turns
                                               ///< them into posed space.
};

}  // namespace sunder
