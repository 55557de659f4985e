#include "tear/sheet/faces_near.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/internal/prefetch.h"
#include "tear/internal/surface.h"
#include "tear/posed/plane_distances.h"

namespace sunder::tear {
namespace {

bool has_displacements(const Mesh& mesh) {
  return std::any_of(mesh.morph_targets.begin(), mesh.morph_targets.end(),
                     [](const MorphTarget& target) { return !target.position_deltas.empty(); });
}

/// Appends the faces of a mesh that may meet the plane, after comparing all of its vertices. On a
/// surface that stays in the cache, this takes less time than bounding the patches.
void scan(Index mesh, const PlaneDistances& distances, const SurfaceEditor& editor,
          ScratchVector<Index>& near) {
  const Mesh& of = editor.character().meshes[mesh];
  const Index source_count = editor.source().meshes[mesh].vertex_count(), count = of.vertex_count(),
              triangle_count = of.triangle_count();
  ScratchVector<std::uint8_t> of_vertices(count, PlaneDistances::kAcross, &editor.scratch());
  std::uint8_t* const sides = of_vertices.data();
  const PlaneDistances::Error error =
      distances.error_at(3 * editor.surface().largest_coordinate[mesh]);
  // Through local pointers: a byte that is written could be a part of anything else.
  const Vec3f* const positions = of.positions.data();
  const Index* const first = of.weights.first.data();
  const Influence* const influences = of.weights.influences.data();
  for (Index v = 0; v < source_count; ++v)
    sides[v] =
        distances.side_of(positions[v], {influences + first[v], influences + first[v + 1]}, error);
  for (Index v = source_count; v < count; ++v)
    sides[v] =
        distances.side_of(editor.births.position(mesh, v), editor.births.influences(mesh, v));
  const Triangle* const triangles = of.triangles.data();
  for (Index t = 0; t < triangle_count; ++t) {
    const auto& [a, b, c] = triangles[t];
    if ((sides[a] | sides[b] | sides[c]) != PlaneDistances::kAcross) continue;
    const Index face = editor.origins.surface_triangle(mesh, t);
    if (!editor.surface().has_repeated_point(face)) near.push_back(face);
  }
}

/// Compares faces of a mesh with a plane, some hundreds at a time: so most of their vertices are
/// compared once, and their memory is fetched before.
class FacesOfMesh {
 public:
  /// @param near  faces that may meet the plane are appended.
  FacesOfMesh(Index mesh, const PlaneDistances& distances, const SurfaceEditor& editor,
              ScratchVector<Index>& near)
      : mesh_(mesh),
        of_(editor.character().meshes[mesh]),
        source_vertices_(editor.source().meshes[mesh].vertex_count()),
        source_triangles_(editor.source().meshes[mesh].triangle_count()),
        distances_(distances),
        editor_(editor),
        near_(near) {
    known_vertex_.fill(kNone);
  }

  /// Prefetches what add() reads first.
  void fetch(std::span<const Index> origins, Index end) const {
    for (const Index origin : origins) {
      if (origin >= end) continue;
      if (origin < source_triangles_) prefetch(&of_.triangles[origin]);
      editor_.origins.fetch_newest_part({mesh_, origin, origin});
    }
  }
  /// Adds the faces of some origins, but not of those from `end` on.
  void add(std::span<const Index> origins, Index end) {
    const Surface& surface = editor_.surface();
    for (const Index origin : origins) {
      if (origin >= end) continue;
      if (origin < source_triangles_)
        add(surface.first_triangle[mesh_] + origin, of_.triangles[origin]);
      editor_.origins.for_each_appended_part(mesh_, origin, [&](Index face) {
        add(face, of_.triangles[surface.triangle(face).triangle]);
      });
    }
  }
  /// Compares those that were added last.
  void finish() {
    compare();
    const Surface& surface = editor_.surface();
    for (std::size_t i = 0; i < face_count_; ++i) {
      const auto& [a, b, c] = corners_[i];
      if ((sides_[a] | sides_[b] | sides_[c]) == PlaneDistances::kAcross &&
          !surface.has_repeated_point(faces_[i]))
        near_.push_back(faces_[i]);
    }
    face_count_ = vertex_count_ = 0;
    known_vertex_.fill(kNone);
  }

 private:
  static constexpr std::size_t kFaces = 256, kKnown = 1024;

  void add(Index face, const Triangle& vertices) {
    if (face_count_ == kFaces) finish();
    faces_[face_count_] = face;
    for (std::size_t k = 0; k < 3; ++k) corners_[face_count_][k] = number_of(vertices[k]);
    ++face_count_;
  }
  /// The number of a vertex among those that are compared next. One that was forgotten gets
  /// another. The vertices that faces share cannot be predicted, so nothing branches here.
  std::uint16_t number_of(Index vertex) {
    const std::size_t place = vertex % kKnown;
    const bool is_known = known_vertex_[place] == vertex;
    const std::uint16_t number = is_known ? known_number_[place] : vertex_count_;
    known_vertex_[place] = vertices_[vertex_count_] = vertex;
    known_number_[place] = number;
    vertex_count_ = static_cast<std::uint16_t>(vertex_count_ + (is_known ? 0 : 1));
    return number;
  }
  void compare() {
    const std::span<const Index> vertices = std::span(vertices_).first(vertex_count_);
    const auto is_of_source = [&](Index vertex) { return vertex < source_vertices_; };
    for (const Index vertex : vertices) {
      prefetch(&of_.positions[vertex]);
      prefetch(&of_.weights.first[vertex]);
    }
    for (const Index vertex : vertices)
      prefetch(of_.weights.influences.data() + of_.weights.first[vertex]);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      sides_[i] = is_of_source(vertices[i])
                      ? distances_.side_of(of_.positions[vertices[i]], of_.weights.of(vertices[i]))
                      : distances_.side_of(editor_.births.position(mesh_, vertices[i]),
                                           editor_.births.influences(mesh_, vertices[i]));
  }

  Index mesh_;
  const Mesh& of_;
  Index source_vertices_, source_triangles_;
  const PlaneDistances& distances_;
  const SurfaceEditor& editor_;
  ScratchVector<Index>& near_;
  std::size_t face_count_ = 0;
  std::uint16_t vertex_count_ = 0;
  std::array<Index, kFaces> faces_;
  std::array<std::array<std::uint16_t, 3>, kFaces> corners_;  ///< Per face: in vertices_.
  std::array<Index, 3 * kFaces + 1> vertices_;
  std::array<std::uint8_t, 3 * kFaces> sides_;
  /// Per place: a vertex and its number.
  std::array<Index, kKnown> known_vertex_;
  std::array<std::uint16_t, kKnown> known_number_;
};

/// The origins of a patch; those from `end` on were undone.
struct Patch {
  std::span<const Index> origins;
  Index end;
};

/// Appends the faces of a mesh that may meet the plane, from the patches that may meet the sheet.
/// @param from_bounds  the distances from the bounds of the sheet.
void search(Index mesh, const PlaneDistances& distances,
            std::span<const PlaneDistances> from_bounds, const SurfaceEditor& editor,
            PosedPoints& posed, ScratchVector<Index>& near) {
  constexpr std::size_t kAhead = 8;
  ScratchVector<Patch> patches(&editor.scratch());
  const auto may_meet = [&](const PatchTree& tree, Index level, Index number) {
    return tree.side_of(level, number, distances) == PlaneDistances::kAcross &&
           std::none_of(from_bounds.begin(), from_bounds.end(), [&](const PlaneDistances& bound) {
             return tree.side_of(level, number, bound) == PlaneDistances::kOutside;
           });
  };
  posed.forest().for_each_group(
      editor, mesh, may_meet, [&](const PatchTree& tree, Index group, Index end) {
        std::uint32_t across = tree.patches_across(group, distances);
        for (Index patch = PatchTree::kPatchesPerGroup * group; across != 0; ++patch, across >>= 1)
          if ((across & 1) != 0) patches.push_back({tree.origins(patch), end});
      });
  FacesOfMesh faces(mesh, distances, editor, near);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (i + kAhead < patches.size())
      faces.fetch(patches[i + kAhead].origins, patches[i + kAhead].end);
    faces.add(patches[i].origins, patches[i].end);
  }
  faces.finish();
}

/// Appends the faces of a mesh whose points are where their bind positions and weights put them.
void append_near(const Sheet& sheet, double on_plane, Index mesh, const SurfaceEditor& editor,
                 PosedPoints& posed, ScratchVector<Index>& near) {
  const auto& palette = posed.pose().palette(editor.character().meshes[mesh].skin);
  const PlaneDistances distances(sheet.plane, palette, on_plane, editor.scratch());
  if (sheet.bounds.empty() && editor.surface().point_count() < PosedPoints::kCachedPoints)
    return scan(mesh, distances, editor, near);
  ScratchVector<PlaneDistances> from_bounds(&editor.scratch());
  from_bounds.reserve(sheet.bounds.size());
  for (const Sheet::Bound& bound : sheet.bounds)
    from_bounds.emplace_back(bound.side, palette, 0.0, editor.scratch());
  search(mesh, distances, from_bounds, editor, posed, near);
}

/// Appends all faces of the patches that may meet a sheet.
void append_patches(const Sheet& sheet, double on_plane, const SurfaceEditor& editor,
                    PosedPoints& posed, ScratchVector<Index>& near) {
  const PlaneSide& plane = sheet.plane;
  const Frame frame = posed.frame_along(
      axes_along(plane.normal,
                 sheet.bounds.empty() ? Vec3d(Vec3d::Zero()) : sheet.bounds[0].side.normal),
      editor);
  ScratchVector<FramedPlaneSide> sides(&editor.scratch());
  sides.reserve(sheet.bounds.size() + 2);
  sides.emplace_back(frame, PlaneSide{plane.normal, plane.offset - on_plane});
  sides.emplace_back(frame, PlaneSide{-plane.normal, -plane.offset - on_plane});
  for (const Sheet::Bound& bound : sheet.bounds) sides.emplace_back(frame, bound.side);
  const auto may_meet = [&](const FrameBox& box) {
    return std::none_of(sides.begin(), sides.end(),
                        [&](const FramedPlaneSide& side) { return side.is_beside(box); });
  };
  posed.for_each_face(editor, frame, may_meet, [&](Index face) { near.push_back(face); });
}

}  // namespace

ScratchVector<Index> faces_near(const Sheet& sheet, const SurfaceEditor& editor,
                                PosedPoints& posed) {
  posed.compare_with(sheet.plane);
  const double on_plane = posed.farthest_on_plane(editor);
  ScratchVector<Index> near(&editor.scratch());
  near.reserve(256);
  const auto& meshes = editor.character().meshes;
  if (posed.has_pins() || std::any_of(meshes.begin(), meshes.end(), has_displacements)) {
    append_patches(sheet, on_plane, editor, posed, near);
    return near;
  }
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    append_near(sheet, on_plane, mesh, editor, posed, near);
  return near;
}

}  // namespace sunder::tear
