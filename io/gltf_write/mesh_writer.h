#pragma once

#include <sunder/core/mesh.h>
#include <sunder/io/character_bytes.h>

#include "io/gltf/glb.h"
#include "io/gltf_write/influence_sets.h"

namespace sunder::gltf {

/// Refuses options outside their documented range.
/// @param mesh_count  of the character that is written.
void check_options(const SaveOptions& options, std::size_t mesh_count);

/// How the influences of one mesh are stored.
struct InfluenceForm {
  WeightFormat format = WeightFormat::float32;
  std::uint32_t maximum = 0;  ///< Per vertex; 0: all.
};

/// The form that the options ask for.
/// @param mesh            index of the mesh that is written.
/// @param most_of_source  influences of the vertex of all meshes, as they were loaded, that has the
///                        most: one limit for all, so that borders of meshes stay together. 0
///                        without a source.
[[nodiscard]] InfluenceForm influence_form(const SaveOptions& options, std::uint32_t mesh,
                                           std::uint32_t most_of_source);

/// Appends meshes to a draft as accessors.
class MeshWriter {
 public:
  explicit MeshWriter(GlbDraft& draft) : draft_(draft) {}

  /// The parts of a glTF primitive that describe its vertices; all submeshes of the mesh share
  /// them.
  struct Vertices {
    Json attributes;
    Json targets;  ///< Null if the mesh has none.
  };
  [[nodiscard]] Vertices add_vertices(const Mesh& mesh, const SourceDocument::MeshOrigin& origin,
                                      InfluenceForm form);

  /// Appends targets that displace nothing to a primitive until it has `count`.
  void fill_targets(Json& primitive, std::size_t count);

  /// Whether the mesh is written at all; retired triangles are not.
  [[nodiscard]] static bool has_triangles(const Mesh& mesh);

  /// Indices of one submesh's triangles. @return their accessor; kNone if it has no triangle.
  [[nodiscard]] std::uint32_t add_indices(const Mesh& mesh, std::uint32_t submesh);

 private:
  enum class Bounds { no, yes };
  std::uint32_t add_floats(std::span<const float> values, std::uint32_t components,
                           Bounds bounds = Bounds::no);
  template <class Vector>
  std::uint32_t add_vectors(const std::vector<Vector>& values, Bounds bounds = Bounds::no);
  template <class T>
  std::uint32_t add_integers(const std::vector<std::uint32_t>& values, std::uint32_t components,
                             GlbDraft::ViewTarget target);
  std::uint32_t add_labels(const CustomAttribute& attribute);
  std::uint32_t add_sides(const std::vector<float>& sides);
  std::uint32_t add_accessor(Json accessor);
  void add_influences(const SkinWeights& weights, InfluenceForm form, Json& attributes);
  template <class Weight>
  void add_sets(const InfluenceSets<Weight>& sets, Json& attributes);
  template <class Weight>
  std::uint32_t add_weights(const std::vector<Weight>& weights);
  Json add_targets(const Mesh& mesh);
  std::uint32_t add_zeros(std::size_t count);

  GlbDraft& draft_;
};

}  // namespace sunder::gltf
