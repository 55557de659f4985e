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

/// A float attribute in memory of the caller, packed or interleaved. data == nullptr: the attribute
/// is absent.
template <class Float>
struct StridedFloats {
  Float* data = nullptr;
  std::size_t stride = 0;  ///< Bytes from one vertex to the next, a multiple of 4; 0: packed.
};

/// Influences in the layout of engines: a fixed number of entries per vertex; an entry with weight
/// 0 is unused.
struct InfluenceArrays {
  std::size_t per_vertex = 0;                ///< Number of entries per vertex.
  const std::uint16_t* slots = nullptr;      ///< V x per_vertex.
  std::size_t slot_stride = 0;               ///< Bytes from one vertex to the next; 0: packed.
  const float* weights = nullptr;            ///< V x per_vertex; or
  const std::uint16_t* weights16 = nullptr;  ///< the same as 65535ths.
  std::size_t weight_stride = 0;             ///< Bytes from one vertex to the next; 0: packed.
};

/// Vertices with a separate bind position per influence: p = sum_i M_i q_i with q_i = sum_k beta_k
/// w_ki [v_k; 1] for the corners v_k of a triangle. This follows a point of the triangle exactly in
/// every pose. The last component of q_i is the weight of influence i, which the weights of the
/// mesh hold. Attributes that the mesh lacks are empty arrays.
/// Source: Merry, Marais, Gain, Animation space, TOG 2006 [merry2006animation].
struct InfluencePositions {
  struct Deltas {
    std::vector<Vec3f> positions, normals, tangents;
  };

  std::vector<std::uint32_t> vertices;  ///< Ascending.
  /// One per influence of those vertices, consecutive, in the order of their weights.
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;   ///< As `positions`: sum_k beta_k w_ki n_k.
  std::vector<Vec3f> tangents;  ///< As `positions`.
  /// One per morph target of the mesh: the same sums of its displacements.
  std::vector<Deltas> morph_targets;
};

/// The input of SkinnedMesh, read during calls only.
struct VertexSource {
  std::uint32_t vertex_count = 0;        ///< V.
  StridedFloats<const float> positions;  ///< x y z.
  StridedFloats<const float> normals;    ///< x y z, unit length; or absent.
  StridedFloats<const float> tangents;   ///< x y z w; or absent.
  const SkinWeights* weights = nullptr;  ///< Of V vertices; or
  InfluenceArrays influences;            ///< the same as arrays.
  std::span<const MorphTarget> morph_targets;
  std::uint32_t first_morph_weight = 0;  ///< Index of the weight of target 0 in the pose.
  const InfluencePositions* per_influence = nullptr;  ///< Requires `weights`.
};

/// The vertices of a mesh, in place.
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

/// The output of SkinnedMesh. Attributes without data are not computed.
struct VertexTarget {
  std::uint32_t vertex_count = 0;
  StridedFloats<float> positions;  ///< x y z.
  StridedFloats<float> normals;    ///< x y z.
  StridedFloats<float> tangents;   ///< x y z w.
  /// Whether normals and tangents are scaled to unit length. Otherwise they keep the length that
  /// blending gives them, at most that of the largest scale, so that a shader that normalises them
  /// anyway does not pay twice.
  bool unit_length = false;
};

/// How particles displace a point: a row of a vertex buffer. Weights are >= 0 and sum to one, or
/// are all 0 for a point that nothing displaces.
struct ParticleInfluences {
  std::array<std::uint32_t, 4> particles = {};
  std::array<float, 4> weights = {};  ///< Descending; 0 for unused entries.

  bool operator==(const ParticleInfluences&) const = default;
};

/// How the weights of particles change along the surface around a point: of the four that change
/// most there. At the lip of a tear these can be particles whose weight at the point itself is 0.
struct ParticleGradients {
  std::array<std::uint32_t, 4> particles = {};  ///< Of any, for unused entries.
  /// In the surface's tangent plane, in the pose and space in which they were taken; 1 / metre. 0
  /// for unused entries. They cancel, up to rounding, where all weights around sum to one.
  std::array<Vec3f, 4> of_weights = {Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero()};
};

/// Displacements added to posed vertices: SkinnedMesh::deform() moves a vertex from p, where the
/// bones put it, to p + sum_k w_k U_k. *Posed space* is model space, or the frame given to
/// BonePalette::set().
///
/// With gradients, tangents are mapped by F = I + sum_k U_k g_k^T and normals by its cofactors: the
/// normals of the displaced surface. Tangents are made orthogonal to normals, if both are wanted.
/// Both keep their length, or get unit length if the buffer requests it; the w of tangents is kept.
/// g_k is the stored gradient, of its own particle, times the weighted mean of
/// `model_from_gradient` of the particles that displace the vertex.
struct VertexDisplacements {
  /// One per vertex: its row. kNone, or any index that is not a row: not displaced.
  std::span<const std::uint32_t> vertex_rows;
  /// Rows, for example one per surface point. Particle indices are unchecked, also of weights 0.
  std::span<const ParticleInfluences> influences;
  /// U, one per particle: x y z 0, posed space, metres, finite.
  std::span<const Vec4f> displacements;
  /// The displaced vertices: ascending, disjoint. All others stay where the bones put them.
  std::span<const IndexRange> moved;
  /// One per row; or empty: normals and tangents are not displaced. Particle indices are unchecked.
  std::span<const ParticleGradients> gradients;
  /// One per particle, if there are gradients: transforms them into posed space.
  std::span<const Mat3f> model_from_gradient;
};

}  // namespace sunder
