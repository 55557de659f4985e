// How the editor's arrays grow.

#include <limits>

#include "tear/surface/capacity_exceeded.h"
#include "tear/surface/mesh_vertices.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {
namespace {

/// By which arrays grow that may grow: an eighth, so that a large model is not doubled for the sake of a small tear.
std::size_t growth(std::size_t size, std::size_t more) { return std::max(more, size / 8 + 1024); }

/// Old triangles that change for each one appended, at most: a tear has two or three, and the fans of its points.
constexpr std::size_t kLoggedPerAppended = 6;
/// What an operation needs for a triangle that it appends or changes.
constexpr std::size_t kScratchPerTriangle = 512;

}  // namespace

void SurfaceEditor::reserve(const TornCapacity& capacity) {
  is_fixed_ = capacity.is_fixed();
  const std::size_t triangles = is_fixed_ ? capacity.triangles : growth(surface_.triangle_count(), 0);
  const std::size_t vertices = is_fixed_ ? capacity.vertices : growth(surface_.point_count(), 0);
  for (Index m = 0; m < character_.meshes.size(); ++m) {
    Mesh& mesh = character_.meshes[m];
    const std::size_t of_mesh = is_fixed_ ? vertices : growth(mesh.vertex_count(), 0);
    const std::size_t influences = mesh.weights.influences.size() / std::max(1u, mesh.vertex_count()) + 1;
    reserve_vertices(of_mesh, 3 * influences * of_mesh, mesh);
    const std::size_t triangles_of_mesh = is_fixed_ ? triangles : growth(mesh.triangle_count(), 0);
    mesh.triangles.reserve(mesh.triangle_count() + triangles_of_mesh);
    mesh.triangle_submesh.reserve(mesh.triangle_count() + triangles_of_mesh);
    mesh.custom_attributes.reserve(mesh.custom_attributes.size() + 1);
    if (!is_fixed_) continue;
    births_[m].reserve(vertices);
    records_[m].reserve(vertices);
    fillings_[m].reserve(triangles);
    filling_serials_[m].reserve(triangles);
    appended_triangles_[m].reserve(triangles);
    spare_sides_[m].reserve(mesh.vertex_count() + vertices);
  }
  surface_.corner_point.reserve(surface_.corner_point.size() + 3 * triangles);
  surface_.twin.reserve(surface_.twin.size() + 3 * triangles);
  surface_.point_corner.reserve(surface_.point_corner.size() + vertices);
  newest_entry_.reserve(newest_entry_.size() + triangles);
  if (!is_fixed_) return;
  surface_.appended.reserve(triangles);
  surface_.appended_side.reserve(vertices);
  older_part_.reserve(triangles);
  parents_.reserve(triangles);
  ancestors_.reserve(triangles);
  vertex_mesh_.reserve(vertices);
  additions_.reserve(triangles + 8 * character_.meshes.size());
  log_.reserve(kLoggedPerAppended * triangles);
  side_log_.reserve(vertices);
  scratch_.fix(kScratchPerTriangle * triangles + (std::size_t{1} << 18));
}

template <class T>
void SurfaceEditor::make_room(std::vector<T>& values, std::size_t more, const char* what) {
  if (values.capacity() - values.size() >= more) return;
  if (is_fixed_) throw CapacityExceeded{what};
  values.reserve(values.size() + growth(values.size(), more));
}

void SurfaceEditor::find_room_for_vertices(Index mesh, Index count, Index influences) {
  Mesh& of = character_.meshes[mesh];
  const auto room_for_influences = [&] { return of.weights.influences.capacity() - of.weights.influences.size(); };
  if (room_for_vertices(of) < count || room_for_influences() < influences) {
    if (is_fixed_) throw CapacityExceeded{"vertices"};
    reserve_vertices(growth(of.vertex_count(), count), growth(of.weights.influences.size(), influences), of);
  }
  std::size_t room = room_for_vertices(of);
  const auto make = [&](auto& values) {
    make_room(values, count, "vertices");
    room = std::min(room, values.capacity() - values.size());
  };
  make(births_[mesh]);
  make(records_[mesh]);
  make(vertex_mesh_);
  make(side_log_);
  make(surface_.point_corner);
  make(surface_.appended_side);
  room_.vertices_of = mesh;
  room_.vertices = room;
  room_.influences = room_for_influences();
}

void SurfaceEditor::find_room_for_triangles(Index mesh, Index count) {
  std::size_t room = std::numeric_limits<std::size_t>::max();
  const auto make = [&](auto& values, std::size_t per_triangle) {
    make_room(values, per_triangle * count, "triangles");
    room = std::min(room, (values.capacity() - values.size()) / per_triangle);
  };
  make(character_.meshes[mesh].triangles, 1);
  make(character_.meshes[mesh].triangle_submesh, 1);
  make(appended_triangles_[mesh], 1);
  make(surface_.corner_point, 3);
  make(surface_.twin, 3);
  make(surface_.appended, 1);
  make(newest_entry_, 1);
  make(older_part_, 1);
  make(parents_, 1);
  make(ancestors_, 1);
  room_.triangles_of = mesh;
  room_.triangles = room;
}

void SurfaceEditor::make_room_for_born(std::size_t influences) {
  // Not limited: only policies take it, and vertices are.
  if (born_.capacity() == born_.size()) born_.reserve(born_.size() + growth(born_.size(), 1));
  if (born_influences_.capacity() - born_influences_.size() < influences)
    born_influences_.reserve(born_influences_.size() + growth(born_influences_.size(), influences));
}

void SurfaceEditor::make_room_for_influences(Index mesh, std::size_t more) {
  make_room(character_.meshes[mesh].weights.influences, more, "influences");
}

void SurfaceEditor::make_room_in_log(std::size_t entries) { make_room(log_, entries, "changes of triangles"); }

void SurfaceEditor::make_room_for_additions(Index mesh) {
  make_room(fillings_[mesh], 1, "triangles");
  make_room(filling_serials_[mesh], 1, "triangles");
  make_room(additions_, 2, "walls and caps");
}

Index SurfaceEditor::influence_count(Index mesh, const Triangle& of) const {
  const SkinWeights& weights = character_.meshes[mesh].weights;
  std::size_t count = 0;
  for (const Index vertex : of) count += weights.of(vertex).size();
  return static_cast<Index>(count);
}

}  // namespace sunder::tear
