#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/weight_options.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "tear/internal/surface.h"
#include "tear/surface/mesh_vertices.h"
#include "tear/surface/scratch_memory.h"
#include "weights/internal/animation_point.h"

namespace sunder::tear {

/// Refines and opens the surface, and with it the meshes: the only place that changes either. Every
/// change is logged, so that it can be taken back to any earlier mark, bit for bit.
class SurfaceEditor {
 public:
  SurfaceEditor(const Character& source, Character& character);

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const Character& character() const { return character_; }
  /// For what lives no longer than the operation under way.
  [[nodiscard]] ScratchMemory& scratch() const { return scratch_; }
  [[nodiscard]] const Character& source() const { return source_; }
  [[nodiscard]] Index vertex_at(Index corner) const {
    const TriangleRef ref = surface_.triangle(corner / 3);
    return character_.meshes[ref.mesh].triangles[ref.triangle][corner % 3];
  }
  [[nodiscard]] bool is_source_vertex(Index corner) const {
    return vertex_at(corner) < source_.meshes[surface_.triangle(corner / 3).mesh].vertex_count();
  }
  /// Whether the faces at both sides of an edge are parts of one source triangle.
  [[nodiscard]] bool is_inner_edge(Index half_edge) const {
    const Index twin = surface_.twin[half_edge];
    // Of two triangles of one origin, one at least was appended.
    if (twin == kNone || std::max(half_edge, twin) / 3 < surface_.first_triangle.back())
      return false;
    const TriangleRef here = surface_.triangle(half_edge / 3), there = surface_.triangle(twin / 3);
    return here.mesh == there.mesh && here.source_triangle == there.source_triangle;
  }
  /// Birth of a vertex that is not of the source.
  [[nodiscard]] const Birth& birth(Index mesh, Index vertex) const {
    return births_[mesh][vertex - source_.meshes[mesh].vertex_count()];
  }

  struct Mark;

  // ---- Weights. Tears are found on the surface that births alone give, so that neither the policy
  // of a point nor the time at which a fit arrived changes where a tear runs. Only arrays of the
  // character have what policies made of it.

  /// A vertex of a mesh.
  struct VertexRef {
    Index mesh = kNone, vertex = kNone;

    bool operator==(const VertexRef&) const = default;
  };
  /// Of which vertex one is a copy, or another vertex at the same point: the one that was there
  /// first. Its own, if none was.
  [[nodiscard]] VertexRef original(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? VertexRef{mesh, vertex}
                                 : records_[mesh][vertex - source_count].original;
  }
  /// What its weights were made by.
  [[nodiscard]] WeightPolicy policy(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? WeightPolicy::barycentric
                                 : records_[mesh][vertex - source_count].policy;
  }
  /// Bind position and influences by birth alone. The influences are good until the next change.
  [[nodiscard]] const Vec3f& born_position(Index mesh, Index vertex) const {
    const Index at = born_at(mesh, vertex);
    return at == kNone ? character_.meshes[mesh].positions[vertex] : born_[at].position;
  }
  [[nodiscard]] std::span<const Influence> born_influences(Index mesh, Index vertex) const {
    const Index at = born_at(mesh, vertex);
    if (at == kNone) return character_.meshes[mesh].weights.of(vertex);
    return std::span(born_influences_)
        .subspan(born_[at].first_influence, born_[at].influence_count);
  }
  /// Whether a policy may give a vertex other weights: it lies between corners, and is nobody's
  /// copy.
  [[nodiscard]] bool is_weighable(Index mesh, Index vertex) const;
  /// What a vertex has, or is to have.
  struct VertexWeights {
    Index mesh = 0, vertex = 0;
    WeightPolicy policy = WeightPolicy::barycentric;
    Vec3f position = Vec3f::Zero();
    Index first_influence = 0, influence_count = 0;  ///< In WeightChange::influences.
    Index born = kNone;
  };
  struct WeightChange {
    std::vector<VertexWeights>
        vertices;  ///< Ascending in each mesh, mesh after mesh; none of the source.
    std::vector<Influence> influences;
  };
  /// Gives vertices what is in `change`, and puts there what they had: once more takes it back.
  /// @throws CapacityExceeded, std::bad_alloc before anything is changed
  void exchange(WeightChange& change);
  /// Keeps what a vertex was born with, which is about to get other weights. @return what
  /// VertexWeights::born is.
  [[nodiscard]] Index keep_born(Index mesh, Index vertex);
  /// A vertex as what moves it exactly in every pose: where it lies between vertices that are not
  /// between others. Whatever policy they have. Morph targets at these weights.
  void describe_exactly(const VertexRef& original, std::span<const float> morph_weights,
                        AnimationPoint& point) const;
  /// How many vertices each mesh had.
  [[nodiscard]] std::vector<Index> vertex_counts_at(const Mark& mark) const;
  /// What exchange() changes, before or after it.
  void describe(const WeightChange& exchanged, ChangeRecord& change) const;
  [[nodiscard]] const InfluencePositions& influence_positions(Index mesh) const {
    return exact_[mesh];
  }
  /// Where an exact vertex' positions begin among those of its mesh.
  [[nodiscard]] std::size_t exact_place(Index mesh, Index vertex) const {
    const auto& vertices = exact_[mesh].vertices;
    return exact_first_[mesh][static_cast<std::size_t>(
        std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin())];
  }
  [[nodiscard]] bool has_exact() const {
    return std::any_of(exact_.begin(), exact_.end(),
                       [](const InfluencePositions& of) { return !of.vertices.empty(); });
  }
  /// Brings influence_positions() up to date for the vertices from `first` up. O(exact vertices
  /// from there).
  void update_exact(Index mesh, Index first);

  /// Triangles of walls and caps as they were made.
  [[nodiscard]] const std::vector<Triangle>& fillings(Index mesh) const { return fillings_[mesh]; }
  /// A number that no other filling ever had; they ascend. @param origin  the filling's, as in
  /// origin_triangle().
  [[nodiscard]] std::uint64_t filling_serial(Index mesh, Index origin) const {
    return filling_serials_[mesh][origin - source_.meshes[mesh].triangle_count()];
  }
  [[nodiscard]] std::uint64_t next_filling_serial() const { return next_serial_; }
  /// A triangle of the source or, beyond those, of a wall or cap: what births refer to.
  [[nodiscard]] const Triangle& origin_triangle(Index mesh, Index triangle) const {
    const Index source_count = source_.meshes[mesh].triangle_count();
    return triangle < source_count ? source_.meshes[mesh].triangles[triangle]
                                   : fillings_[mesh][triangle - source_count];
  }

  /// The surface's number of a mesh's triangle. Appended triangles are numbered in the order in
  /// which they were made, over all meshes.
  [[nodiscard]] Index surface_triangle(Index mesh, Index triangle) const {
    const Index source_count = source_.meshes[mesh].triangle_count();
    return triangle < source_count ? surface_.first_triangle[mesh] + triangle
                                   : appended_triangles_[mesh][triangle - source_count];
  }
  /// Calls visit(triangle of the surface) for each face that is a part of an origin, as far as
  /// there still are any.
  template <class Visit>
  void for_each_part(Index mesh, Index origin, Visit visit) const {
    const auto visit_face = [&](Index triangle) {
      if (!surface_.has_repeated_point(triangle)) visit(triangle);
    };
    if (origin < source_.meshes[mesh].triangle_count())
      visit_face(surface_.first_triangle[mesh] + origin);
    if (origin >= newest_part_[mesh].size()) return;
    for (Index part = newest_part_[mesh][origin]; part != kNone;
         part = older_part_[part - surface_.first_triangle.back()])
      visit_face(part);
  }
  /// Barycentric coordinates of a corner in the triangle's origin.
  [[nodiscard]] std::array<double, 3> source_barycentric(Index corner) const {
    return place_in_origin(surface_.triangle(corner / 3), vertex_at(corner));
  }

  // ---- Room.

  /// How much operations may append; the arrays get room for it.
  void reserve(const TornCapacity& capacity);

  // ---- Refining: the surface stays what it is.

  /// Whether a face is a triangle of the source that nothing has changed.
  [[nodiscard]] bool is_whole(Index triangle) const {
    if (triangle >= surface_.first_triangle.back()) return false;
    const TriangleRef ref = surface_.triangle(triangle);
    return is_same(character_.meshes[ref.mesh].triangles[ref.triangle],
                   source_.meshes[ref.mesh].triangles[ref.triangle]);
  }
  /// Asks memory for what crossing a face will need.
  void fetch(Index triangle) const;
  class FaceSplit;
  /// Splits faces one after the other along a line.
  class Crossing;

  /// Puts one new point on an edge, `fraction` of the way along the half-edge, and splits the faces
  /// at both sides of it.
  /// @return the point; kNone where a face would have lost its area or turned over, and nothing was
  /// changed.
  [[nodiscard]] Index split_edge(Index half_edge, double fraction);
  /// Puts a new point into a triangle and splits it in three. `barycentric`: of its corners, all >
  /// 0.
  /// @return as split_edge().
  [[nodiscard]] Index split_triangle(Index triangle, const std::array<double, 3>& barycentric);
  /// Replaces the edge between two faces of one source triangle by the other diagonal of their
  /// quadrilateral: (a, b, c), (b, a, d) become (a, d, c), (b, c, d).
  /// @return false where they are of different triangles, or a face would lose its area or turn
  /// over; nothing was changed.
  bool flip_edge(Index half_edge);

  /// From here on ancestor() asks which triangle stood there now.
  void begin_stage();
  [[nodiscard]] Index ancestor(Index triangle) const {
    return triangle < stage_begin_ ? triangle : ancestors_[triangle - stage_begin_];
  }
  [[nodiscard]] Index stage_begin() const { return stage_begin_; }

  // ---- Opening and removing.

  /// From here on opened() asks for the borders that cut_edge() made since, if `keeps_opened`.
  void begin_opening(bool keeps_opened);
  /// Border half-edges, ascending, wherever splitting and turning took them.
  [[nodiscard]] std::vector<Index> opened() const;
  /// All that opened() goes by, so that a call that fails can put it back.
  [[nodiscard]] const std::unordered_set<Index>& opened_half_edges() const { return opened_; }
  void restore_opened(std::unordered_set<Index>& before) { opened_.swap(before); }

  /// Disconnects the faces at both sides of a half-edge.
  void cut_edge(Index half_edge);
  /// Gives a fan a point of its own. Vertices that faces of other fans use are duplicated.
  /// @param corners    of the fan, all.
  /// @param remaining  a corner of each other fan that this point has.
  Index separate_fan(std::span<const Index> corners, std::span<const Index> remaining);
  /// The same of the left one of the two fans that are left of a point through which a path was
  /// cut, by the path's half-edges that arrive there and leave, and those across them.
  /// @return kNone, and nothing has changed, where there is more to it: other fans, borders or
  /// several vertices at the point.
  Index separate_left(Index arriving, Index leaving, Index across_arriving, Index across_leaving);
  /// Takes a triangle away whose edges are all cut. Its points keep no corner of it.
  void retire_triangle(Index triangle);
  /// Names the corner that a point is known by.
  void set_point_corner(Index point, Index corner) { surface_.point_corner[point] = corner; }

  // ---- Walls and caps.

  [[nodiscard]] Index append_submesh(Index mesh, const std::string& name, Index material);
  /// A vertex at the point of another one, of a mesh with the same skin. It is born when a filling
  /// uses it.
  [[nodiscard]] Index append_rim_vertex(Index mesh, const VertexRef& like);
  /// A vertex with the attributes of another one, and with its bind position and influences by
  /// birth: to be changed before anyone sees it.
  [[nodiscard]] Index append_filling_vertex(Index mesh, Index like);
  [[nodiscard]] Mesh& mesh_of_new_vertex(Index mesh) { return character_.meshes[mesh]; }
  [[nodiscard]] Index append_filling_point() { return append_point(); }
  /// A triangle that no triangle of the source covers. Unconnected; see connect().
  Index append_filling(Index mesh, Index submesh, const std::array<Index, 3>& points,
                       const Triangle& vertices);
  /// Joins two border half-edges that run between the same points in opposite directions.
  void connect(Index a, Index b);

  // ---- Operations.

  /// A state to come back to.
  struct Mark {
    Index points = 0;
    Index triangles = 0;
    Index vertices = 0;   ///< Appended, over all meshes.
    Index additions = 0;  ///< Fillings, submeshes, attributes.
    Index born = 0;       ///< Vertices whose birth is kept beside other weights.
    Index next_side = 1;
    Index log_length = 0;
    Index side_log_length = 0;
  };
  /// Changes are logged once from here on, so that any mark can be rolled back to. O(1).
  [[nodiscard]] Mark mark();
  void roll_back(const Mark& to);

  /// Calls visit(triangle) once for each triangle that was there at `begin` and changed since,
  /// retired ones too, in the order in which they changed.
  template <class Visit>
  void for_each_changed(const Mark& begin, Visit visit) const {
    for (Index i = begin.log_length; i < log_.size(); ++i)
      if (is_oldest_since(begin, i)) visit(log_[i].triangle);
  }
  /// Calls visit(triangle, its neighbour) for the neighbours that those triangles had at `begin`.
  template <class Visit>
  void for_each_former_neighbour(const Mark& begin, Visit visit) const {
    for (Index i = begin.log_length; i < log_.size(); ++i)
      if (is_oldest_since(begin, i))
        for (const Index twin : log_[i].twins)
          if (twin != kNone) visit(log_[i].triangle, twin / 3);
  }
  /// Numbers the triangles that changed or were appended since, without gaps of note; kNone for
  /// others.
  [[nodiscard]] Index number_since(const Mark& begin, Index triangle) const {
    const Index changes = static_cast<Index>(log_.size()) - begin.log_length;
    if (triangle >= begin.triangles) return changes + triangle - begin.triangles;
    const Index entry = newest_entry_[triangle];
    return entry == kNone || entry < begin.log_length ? kNone : entry - begin.log_length;
  }
  [[nodiscard]] Index numbers_since(const Mark& begin) const {
    return static_cast<Index>(log_.size()) - begin.log_length + surface_.triangle_count() -
           begin.triangles;
  }
  /// The triangle that an appended one was split from; kNone for those of walls and caps.
  [[nodiscard]] Index parent(Index triangle) const {
    const Index parent = parents_[triangle - surface_.first_triangle.back()];
    return parent == kNone ? kNone : parent & ~kSettled;
  }
  /// Whether a triangle of the source was split along the best diagonal and not again since, or
  /// another is one of those parts.
  [[nodiscard]] bool is_settled(Index triangle) const {
    if (triangle < surface_.first_triangle.back()) {
      const TriangleRef ref = surface_.triangle(triangle);
      if (ref.source_triangle >= newest_part_[ref.mesh].size()) return false;
      triangle = newest_part_[ref.mesh][ref.source_triangle];
      if (triangle == kNone) return false;
    }
    const Index parent = parents_[triangle - surface_.first_triangle.back()];
    return parent != kNone && (parent & kSettled) != 0;
  }
  /// Vertices appended since, over all meshes.
  [[nodiscard]] Index vertices_since(const Mark& begin) const {
    return static_cast<Index>(vertex_mesh_.size()) - begin.vertices;
  }

  /// Fills in what changed since `begin`, but for lips and rims.
  void describe(const Mark& begin, ChangeRecord& change) const;

  /// Fills in what roll_back(begin) is going to change; lips and rims are none.
  void describe_roll_back(const Mark& begin, ChangeRecord& change) const;

  /// Takes back the newest operation, which began at `begin`. @param redo  is made what does it
  /// again.
  struct Redo;
  void undo(const Mark& begin, Redo& redo, ChangeRecord& change);
  /// @param change  filled in but for lips and rims.
  void redo(const Redo& redo, ChangeRecord& change);

 private:
  /// A triangle as it was before a change, and the corner that its points were known by.
  struct LogEntry {
    Index triangle;
    Index previous;  ///< Entry of the same triangle, kNone for none.
    std::array<Index, 3> points;
    std::array<Index, 3> twins;
    std::array<Index, 3> point_corners;
    Triangle vertices;
  };
  struct SideEntry {
    Index mesh, vertex;
    float side;
  };
  struct Addition {
    enum class Kind : std::uint8_t { filling, submesh, tear_sides } kind;
    Index mesh;
  };
  struct MeshSizes {
    Index vertices = 0, triangles = 0;
  };
  /// What is known of an appended vertex besides its birth.
  struct VertexRecord {
    VertexRef original;
    Index born = kNone;  ///< In born_; kNone: the mesh has what it was born with.
    WeightPolicy policy = WeightPolicy::barycentric;
  };
  /// What a vertex was born with that has other weights now.
  struct Born {
    Vec3f position;
    Index first_influence, influence_count;
  };
  [[nodiscard]] Index born_at(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count || born_.empty() ? kNone
                                                  : records_[mesh][vertex - source_count].born;
  }
  [[nodiscard]] VertexRecord record_of(Index mesh, Index vertex) const {
    const Index source_count = source_.meshes[mesh].vertex_count();
    return vertex < source_count ? VertexRecord{{mesh, vertex}}
                                 : records_[mesh][vertex - source_count];
  }
  void interpolate_born(const Triangle& corners, const std::array<double, 3>& barycentric,
                        Index mesh);
  void add_exactly(double part, Index mesh, Index vertex, std::span<const float> morph_weights,
                   AnimationPoint& point) const;
  /// Forgets influence positions of the vertices from `first` up, which are still there.
  void forget_exact(Index mesh, Index first);
  void append_exact(Index mesh, Index vertex);
  /// So that an exchange is not left half done for want of memory.
  void reserve_exact(Index mesh, std::size_t vertices, std::size_t influences);
  template <class Value>
  [[nodiscard]] Eigen::Vector3d moved_by(Index slot, const VertexRef& vertex, bool follows_original,
                                         Value value) const;
  void resize_born(Index count);

  [[nodiscard]] bool is_oldest_since(const Mark& begin, Index entry) const {
    const Index previous = log_[entry].previous;
    return log_[entry].triangle < begin.triangles &&
           (previous == kNone || previous < begin.log_length);
  }
  /// Of each mesh. Valid until asked again.
  [[nodiscard]] std::span<const MeshSizes> sizes_at(const Mark& mark) const;
  /// Writes what the entry's triangle is now.
  void fill(LogEntry& entry) const;
  /// Lets what follows append as much without any array growing: a change is not left half done for
  /// want of memory. The vertices are like others of the mesh.
  /// @throws CapacityExceeded, std::bad_alloc
  void make_room_for_vertices(Index mesh, Index count, Index influences) {
    if (room_.vertices_of != mesh || room_.vertices < count || room_.influences < influences)
      find_room_for_vertices(mesh, count, influences);
    room_.vertices -= count;
    room_.influences -= influences;
  }
  void make_room_for_triangles(Index mesh, Index count) {
    if (room_.triangles_of != mesh || room_.triangles < count) find_room_for_triangles(mesh, count);
    room_.triangles -= count;
  }
  void find_room_for_vertices(Index mesh, Index count, Index influences);
  void find_room_for_triangles(Index mesh, Index count);
  void make_room_for_born(std::size_t influences);
  void make_room_for_influences(Index mesh, std::size_t more);
  void make_room_in_log(std::size_t entries);
  void make_room_for_additions(Index mesh);
  template <class T>
  void make_room(std::vector<T>& values, std::size_t more, const char* what);
  [[nodiscard]] Index influence_count(Index mesh, const Triangle& of) const;

  void log_triangle(Index triangle);
  void restore(const LogEntry& entry);
  void set_corner(Index corner, Index point, Index vertex);
  void join(Index a, Index b);
  void move_opened(Index from, Index to);
  Index append_triangle(Index like, const std::array<Index, 3>& points, const Triangle& vertices);
  Index append_point();
  /// Puts appended triangles at the head of their origin's chain, or takes those from `first` up
  /// off again.
  void chain_new_parts();
  void unchain_parts_from(Index first);
  Index append_vertex(Index mesh, const Birth& birth);
  void remove_newest_vertex(Index mesh);
  /// Where a vertex lies in the origin of a triangle.
  [[nodiscard]] std::array<double, 3> place_in_origin(const TriangleRef& ref, Index vertex) const;
  /// A copy of a vertex at the same place of the surface. @param corner  that it has.
  Index append_duplicate(Index mesh, Index vertex, Index corner);
  void write_side(Index mesh, Index vertex, Index side);
  /// The same for a vertex that is taken back with what needs it.
  void write_side_of_new(Index mesh, Index vertex, Index side);
  /// Entry `at` of a record, as new, in the memory of the one that was there.
  static MeshChange& renew_change(std::size_t at, Index mesh, ChangeRecord& change);
  /// @param sides  what was written to _TEARSIDE.
  void fill_dirty_ranges(std::span<const SideEntry> sides, MeshChange& change) const;
  /// Values of _TEARSIDE; nothing where the mesh has none.
  [[nodiscard]] std::vector<float>* tear_sides(Index mesh);
  void add_tear_sides(Index mesh);
  [[nodiscard]] Triangle vertices_of(Index triangle) const;

  const Character& source_;
  Character& character_;
  Surface surface_;
  std::vector<std::vector<Birth>> births_;  ///< Of each mesh: its vertices beyond the source's.
  std::vector<std::vector<VertexRecord>> records_;  ///< Likewise.
  std::vector<Born> born_;
  std::vector<Influence> born_influences_;
  std::vector<InfluencePositions> exact_;  ///< Of each mesh.
  std::vector<std::vector<Index>>
      exact_first_;  ///< Of each mesh: where the positions of each of its exact vertices begin.
  std::vector<std::vector<Triangle>> fillings_;  ///< Of each mesh.
  std::vector<std::vector<std::uint64_t>> filling_serials_;
  std::uint64_t next_serial_ = 0;
  std::vector<std::vector<Index>> appended_triangles_;  ///< Of each mesh: the surface's numbers of
                                                        ///< its triangles beyond the source's.
  std::vector<Index> vertex_mesh_;                      ///< Of each appended vertex.
  std::vector<std::vector<Index>> newest_part_;         ///< Of each mesh: of each origin, the last
                                                        ///< triangle appended that is a part of it.
  std::vector<Index>
      older_part_;  ///< Of each appended triangle: the one before it of the same origin.
  std::vector<Addition> additions_;
  std::vector<LogEntry> log_;  ///< Of all operations that were done and not taken back.
  std::vector<SideEntry> side_log_;
  std::vector<Index> newest_entry_;  ///< Of each triangle, in the log.
  Mark logged_since_;  ///< The newest mark: what was logged or appended since need not be logged
                       ///< again.
  std::vector<Index> side_attribute_;  ///< Of each mesh, in its custom attributes; kNone without.
  std::vector<std::vector<float>>
      spare_sides_;  ///< Of each mesh: what an attribute that was taken back used, all zero.
  /// First value of _TEARSIDE that no point has. Each point that is made gets one: however tears
  /// cross, and wherever positions round to, no two points in one place are taken for one.
  Index next_side_ = 1;
  static constexpr Index kSettled = Index{1}
                                    << 31;  // beside a triangle's number, which is less than 2^30
  std::vector<Index>
      parents_;  ///< Of each appended triangle: what it was split from, and kSettled.
  bool keeps_opened_ = false;
  mutable std::vector<MeshSizes> sizes_;
  bool is_fixed_ = false;
  /// What was found to have room last, less what was asked for since: there is at least that much.
  struct Room {
    Index vertices_of = kNone, triangles_of = kNone;  ///< Mesh.
    std::size_t vertices = 0, influences = 0, triangles = 0;
  };
  Room room_;
  mutable ScratchMemory scratch_;
  std::unordered_set<Index> opened_;  // asked and sorted, never walked through as it is
  Index stage_begin_ = 0;
  std::vector<Index> ancestors_;  ///< Of the triangles appended since.
};

/// What an operation had made when it was taken back.
struct SurfaceEditor::Redo {
  struct OfMesh {
    Mesh vertices;
    std::vector<Triangle> triangles;
    std::vector<Index> triangle_submesh;
    std::vector<Submesh> submeshes;
    std::vector<Birth> births;
    std::vector<VertexRecord> records;
    std::vector<Triangle> fillings;
    std::vector<Index> appended_triangles;
  };
  std::vector<OfMesh> meshes;
  std::vector<Born> born;
  std::vector<Influence> born_influences;
  std::vector<Index> corner_point, twin, point_corner, side, parents, vertex_mesh;
  std::vector<TriangleRef> triangles;
  std::vector<Addition> additions;
  std::vector<LogEntry> log;
  std::vector<SideEntry> side_log;
  Index next_side = 1;
  std::vector<LogEntry> changed;  ///< Triangles that were there before, as the operation left them.
  std::vector<std::array<Index, 2>>
      known_corners;  ///< Points that were there before, and the corners they were known by.
  std::vector<SideEntry> sides;
};

}  // namespace sunder::tear
