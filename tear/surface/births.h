#pragma once

#include <array>
#include <span>

#include "tear/surface/edit_columns.h"
#include "tear/surface/fillings.h"
#include "tear/surface/room.h"
#include "tear/surface/scratch_memory.h"
#include "weights/internal/animation_point.h"

namespace sunder::tear {

/// What appended vertices were born with: where in which origin, and the bind position and
/// influences that follow from it.
///
/// Tears are found on the surface that births alone give, so that neither the weight policy of a
/// point nor the time at which a fit arrived changes where a tear runs. Only the meshes of the
/// character have what policies made of it.
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
  /// Those of the last `count` vertices of a mesh.
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
  /// The policy that made its weights.
  [[nodiscard]] WeightPolicy policy(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? WeightPolicy::barycentric
                                 : columns_.meshes[mesh].records[vertex - source_count].policy;
  }
  /// The index of what it was born with in EditColumns::kept_births; kNone if its mesh has that.
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
  /// Describes a vertex by what moves it exactly in every pose, whatever its policy: by the
  /// vertices that it lies between and that do not lie between others. @param morph_weights  at
  /// which morph targets are added.
  void describe_exactly(const VertexRef& vertex, std::span<const float> morph_weights,
                        AnimationPoint& point) const;

  // ---- Appending. There must be room, except where a function makes it.

  /// A vertex that is interpolated in an origin.
  Index append(Index mesh, const Birth& birth);
  /// A copy of a vertex at the same point. @param triangle  that has the vertex.
  Index append_duplicate(Index mesh, Index vertex, const TriangleRef& triangle);
  /// A vertex at the point of another one, of a mesh with the same skin. It is born when a filling
  /// uses it. Makes room.
  [[nodiscard]] Index append_rim_vertex(Index mesh, const VertexRef& like);
  /// A vertex with the attributes of another one, and with its bind position and influences by
  /// birth, to be changed before anyone sees it. It is born when a filling uses it. Makes room.
  [[nodiscard]] Index append_filling_vertex(Index mesh, Index like);
  /// A filling uses a vertex as one of its corners (0, 1, 2).
  void give_birth(Index mesh, Index vertex, Index filling, Index corner);
  void remove_newest(Index mesh);
  /// Says that the newest vertex of a mesh is at the point of another one.
  void set_original_of_newest(Index mesh, const VertexRef& original) {
    columns_.meshes[mesh].records.back().original = original;
  }
  /// Says by which policy a vertex has its weights. @param kept_birth  what keep() returned, kNone
  /// for weights as born.
  void set_policy(Index mesh, Index vertex, WeightPolicy policy, Index kept_birth) {
    VertexRecord& record =
        columns_.meshes[mesh].records[vertex - source_.meshes[mesh].vertex_count()];
    record.policy = policy;
    record.kept_birth = kept_birth;
  }
  /// Keeps what a vertex was born with, because it is about to get other weights. Makes room.
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
