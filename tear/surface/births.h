#pragma once

#include <array>
#include <span>

#include "tear/surface/edit_columns.h"
#include "tear/surface/fillings.h"
#include "tear/surface/room.h"
#include "tear/surface/scratch_memory.h"
#include "weights/internal/animation_point.h"

namespace sunder::tear {

/// The births of appended vertices: the origin and the place in it, and the bind position and
/// influences that follow from them.
///
/// The paths of tears are computed on the surface given by births alone, so that they depend
/// neither on the weight policy of a point nor on the time at which a fit is complete. Weights made
/// by policies are only in the meshes of the character.
class Births {
 public:
  Births(const Character& source, Character& character, EditColumns& columns,
         const Fillings& fillings, Room& room, ScratchMemory& scratch)
      : source_(source),
        character_(character),
        columns_(columns),
        fillings_(fillings),
        room_(room),
        scratch_(scratch) {}

  /// Birth of an appended vertex.
  [[nodiscard]] const Birth& at(Index mesh, Index vertex) const {
    return columns_.meshes[mesh].births[vertex - source_.meshes[mesh].vertex_count()];
  }
  /// Births of the last `count` vertices of a mesh.
  [[nodiscard]] std::span<const Birth> newest(Index mesh, Index count) const {
    return std::span<const Birth>(columns_.meshes[mesh].births).last(count);
  }
  [[nodiscard]] VertexRecord record(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? VertexRecord{{mesh, vertex}}
                                 : columns_.meshes[mesh].records[vertex - source_count];
  }
  /// The first vertex at the same point, of which this one is a copy; itself if there was none
  /// before.
  [[nodiscard]] VertexRef original(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? VertexRef{mesh, vertex}
                                 : columns_.meshes[mesh].records[vertex - source_count].original;
  }
  /// The policy that made the weights of a vertex.
  [[nodiscard]] WeightPolicy policy(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? WeightPolicy::barycentric
                                 : columns_.meshes[mesh].records[vertex - source_count].policy;
  }
  /// Index of the vertex in EditColumns::kept_births; kNone if its mesh still has the values by
  /// birth.
  [[nodiscard]] Index kept_birth(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    if (vertex < source_count || columns_.kept_births.empty()) return kNone;
    return columns_.meshes[mesh].records[vertex - source_count].kept_birth;
  }
  /// Bind position by birth alone.
  [[nodiscard]] const Vec3f& position(Index mesh, Index vertex) const {
    const Index kept = kept_birth(mesh, vertex);
    return kept == kNone ? character_.meshes[mesh].positions[vertex]
                         : columns_.kept_births[kept].position;
  }
  /// Influences by birth alone. Valid until the next change.
  [[nodiscard]] std::span<const Influence> influences(Index mesh, Index vertex) const {
    const Index kept = kept_birth(mesh, vertex);
    if (kept == kNone) return character_.meshes[mesh].weights.of(vertex);
    const KeptBirth& birth = columns_.kept_births[kept];
    return std::span(columns_.kept_influences)
        .subspan(birth.first_influence, birth.influence_count);
  }
  /// Barycentric coordinates of a vertex of a triangle in the triangle's origin.
  [[nodiscard]] std::array<double, 3> place_in_origin(const TriangleRef& triangle,
                                                      Index vertex) const;
  /// Whether a policy may give a vertex other weights: it lies between corners and is an original.
  [[nodiscard]] bool is_weighable(Index mesh, Index vertex) const;
  /// Describes the exact motion of a vertex in every pose, whatever its policy: by the vertices
  /// between which it lies and that do not lie between others themselves.
  /// @param morph_weights  the weights with which morph targets are added.
  void describe_exactly(const VertexRef& vertex, std::span<const float> morph_weights,
                        AnimationPoint& point) const;

  // ---- Appending. There must be room, except where a function makes it.

  /// Appends a vertex that is interpolated in an origin.
  Index append(Index mesh, const Birth& birth);
  /// Appends a copy of a vertex at the same point. @param triangle  a triangle that has the vertex.
  Index append_duplicate(Index mesh, Index vertex, const TriangleRef& triangle);
  /// Appends a vertex at the point of another one, which may be in another mesh with the same skin.
  /// It gets its birth when a filling uses it. Makes room.
  [[nodiscard]] Index append_rim_vertex(Index mesh, const VertexRef& like);
  /// Appends a vertex with the attributes of another one, and with its bind position and influences
  /// by birth; the caller changes them. It gets its birth when a filling uses it. Makes room.
  [[nodiscard]] Index append_filling_vertex(Index mesh, Index like);
  /// Sets the birth of a vertex that a filling uses as one of its corners (0, 1, 2).
  /// @return false if an earlier filling uses the vertex; then its birth stays.
  bool give_birth(Index mesh, Index vertex, Index filling, Index corner);
  void remove_newest(Index mesh);
  /// Sets the original of the newest vertex of a mesh.
  void set_original_of_newest(Index mesh, const VertexRef& original) {
    columns_.meshes[mesh].records.back().original = original;
  }
  /// Sets the policy that made the weights of a vertex.
  /// @param kept_birth  the result of keep(); kNone for weights by birth.
  void set_policy(Index mesh, Index vertex, WeightPolicy policy, Index kept_birth) {
    VertexRecord& record =
        columns_.meshes[mesh].records[vertex - source_.meshes[mesh].vertex_count()];
    record.policy = policy;
    record.kept_birth = kept_birth;
  }
  /// Keeps the position and influences by birth of a vertex that is about to get other weights.
  /// Makes room.
  /// @return the index in EditColumns::kept_births.
  [[nodiscard]] Index keep(Index mesh, Index vertex);

 private:
  void push(Index mesh, const Birth& birth, const VertexRecord& record);
  void interpolate_newest(const Triangle& corners, const std::array<double, 3>& barycentric,
                          Index mesh);
  void add_exactly(double part, Index mesh, Index vertex, std::span<const float> morph_weights,
                   AnimationPoint& point) const;

  const Character& source_;
  Character& character_;
  EditColumns& columns_;
  const Fillings& fillings_;
  Room& room_;
  ScratchMemory& scratch_;
};

}  // namespace sunder::tear
