#include "tear/surface/room.h"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace sunder::tear {
namespace {

/// Number of entries by which an array grows: an eighth, because doubling a large model for a small
/// tear wastes memory.
std::size_t growth(std::size_t size, std::size_t more) { return std::max(more, size / 8 + 1024); }

/// Changes of old triangles per appended one for which a model of fixed capacity reserves memory:
/// most operations log fewer. One that removes large areas logs more, and allocates.
constexpr std::size_t kChangesPerAppended = 1;
/// A model of fixed capacity reserves memory for walls and caps of a part of its triangles.
constexpr std::size_t kTrianglesPerFilling = 8;
/// Values of _TEARSIDE are logged for old vertices alone, which are fewer than new ones.
constexpr std::size_t kVerticesPerSideChange = 2;

bool comes_with_vertices(Rows rows) {
  return rows == Rows::vertices || rows == Rows::mesh_vertices || rows == Rows::points ||
         rows == Rows::side_changes;
}

/// Whether the capacity limits the number of rows, rather than what they depend on.
bool is_limited(Rows rows) {
  return rows != Rows::side_changes && rows != Rows::mesh_fillings && rows != Rows::additions &&
         rows != Rows::triangle_changes && rows != Rows::scars && rows != Rows::threads;
}

bool comes_with_triangles(Rows rows) {
  return rows == Rows::triangles || rows == Rows::mesh_triangles;
}

template <class Values>
constexpr bool kIsMeshVertices = std::is_same_v<std::remove_cvref_t<Values>, MeshVertices<Mesh>>;

std::size_t room_for_influences(const Mesh& mesh) {
  return mesh.weights.influences.capacity() - mesh.weights.influences.size();
}

/// Number of rows of a column for which a model of fixed capacity reserves memory.
std::size_t fixed_rows(Rows rows, const TornCapacity& capacity, std::size_t mesh_count) {
  if (rows == Rows::side_changes) return capacity.vertices / kVerticesPerSideChange;
  if (comes_with_vertices(rows)) return capacity.vertices;
  if (comes_with_triangles(rows)) return capacity.triangles;
  if (rows == Rows::mesh_fillings) return capacity.triangles / kTrianglesPerFilling;
  if (rows == Rows::additions) return capacity.triangles / kTrianglesPerFilling + 8 * mesh_count;
  if (rows == Rows::triangle_changes) return kChangesPerAppended * capacity.triangles;
  // The caps of either side of a cut may have materials that no earlier ones have.
  if (rows == Rows::mesh_submeshes) return std::size_t{2} * capacity.operations;
  return 0;
}

}  // namespace

std::size_t entries_in_advance(const Column& column, std::size_t size, const TornCapacity& capacity,
                               std::size_t mesh_count) {
  if (capacity.is_fixed()) return column.per_row * fixed_rows(column.rows, capacity, mesh_count);
  // Columns that hold the source too are long: without room the first tear would copy them.
  if (size == 0 || column.rows == Rows::mesh_submeshes) return 0;
  return column.per_row * growth(size / column.per_row, 0);
}

VertexRoom vertices_in_advance(const Mesh& mesh, const TornCapacity& capacity) {
  const std::size_t count =
      capacity.is_fixed() ? capacity.vertices : growth(mesh.vertex_count(), 0);
  // A new vertex has the influences of two or three others, most of them the same.
  const std::size_t of_source = mesh.weights.influences.size(),
                    vertices = std::max(1u, mesh.vertex_count());
  return {count, 3 * (of_source + vertices) * count / (2 * vertices)};
}

void Room::reserve(const TornCapacity& capacity) {
  is_fixed_ = capacity.is_fixed();
  const auto reserve_column = [&](const Column& column, auto&& values) {
    if constexpr (kIsMeshVertices<decltype(values)>) {
      const VertexRoom room = vertices_in_advance(values.mesh, capacity);
      reserve_vertices(room.vertices, room.influences, values.mesh);
    } else {
      values.reserve(values.size() +
                     entries_in_advance(column, values.size(), capacity, columns_.meshes.size()));
    }
  };
  for_each_common_column(reserve_column, columns_);
  for (Index m = 0; m < columns_.meshes.size(); ++m) {
    for_each_mesh_column(m, reserve_column, columns_);
    if (is_fixed_) make_for_tear_sides(m, capacity.vertices);
  }
}

/// Makes room for the values of _TEARSIDE of all vertices and of `count` more, where a mesh lacks
/// the attribute: it is added in the middle of an edit.
void Room::make_for_tear_sides(Index mesh, std::size_t count) {
  MeshColumns& columns = columns_.edit.meshes[mesh];
  const std::size_t vertices = columns_.meshes[mesh].vertex_count();
  if (columns.tear_side == kNone && columns.spare_sides.capacity() < vertices + count)
    columns.spare_sides.reserve(vertices + (is_fixed_ ? count : growth(vertices, count)));
}

template <class Value>
void Room::grow(std::vector<Value>& values, std::size_t more, const char* what) {
  constexpr bool kIsLimited = !std::is_same_v<Value, TriangleChange>;
  if (kIsLimited && is_fixed_ && what != nullptr) throw CapacityExceeded{what};
  values.reserve(values.size() + growth(values.size(), more));
}
// Used by the inline make_for_changes().
template void Room::grow(std::vector<TriangleChange>& values, std::size_t more, const char* what);

/// @return the rows for which all those columns have room.
template <class IsMeant>
std::size_t Room::make_in_columns(Index mesh, std::size_t count, const char* what,
                                  IsMeant is_meant) {
  std::size_t room = std::numeric_limits<std::size_t>::max();
  const auto make = [&](const Column& column, auto&& values) {
    if constexpr (!kIsMeshVertices<decltype(values)>) {
      if (!is_meant(column.rows)) return;
      const std::size_t more = column.per_row * count;
      if (values.capacity() - values.size() < more)
        grow(values, more, is_limited(column.rows) ? what : nullptr);
      room = std::min(room, (values.capacity() - values.size()) / column.per_row);
    }
  };
  for_each_common_column(make, columns_);
  for_each_mesh_column(mesh, make, columns_);
  return room;
}

void Room::find_for_vertices(Index mesh, Index count, Index influences) {
  make_in_mesh(mesh, count, influences);
  make_for_tear_sides(mesh, count);
  const std::size_t room = make_in_columns(mesh, count, "vertices", comes_with_vertices);
  const Mesh& of = columns_.meshes[mesh];
  const MeshColumns& columns = columns_.edit.meshes[mesh];
  known_.vertices_of = mesh;
  known_.vertices = std::min(room, room_for_vertices(of));
  if (columns.tear_side == kNone)
    known_.vertices = std::min(known_.vertices, columns.spare_sides.capacity() - of.vertex_count());
  known_.influences = room_for_influences(of);
}

/// Makes room in the arrays of a mesh.
void Room::make_in_mesh(Index mesh, std::size_t count, std::size_t influences) {
  Mesh& of = columns_.meshes[mesh];
  if (room_for_vertices(of) < count) {
    if (is_fixed_) throw CapacityExceeded{"vertices"};
    reserve_vertices(growth(of.vertex_count(), count),
                     growth(of.weights.influences.size(), influences), of);
  } else if (room_for_influences(of) < influences) {  // which the capacity does not limit
    reserve_vertices(0, growth(of.weights.influences.size(), influences), of);
  }
}

void Room::find_for_triangles(Index mesh, Index count) {
  known_.triangles = make_in_columns(mesh, count, "triangles", comes_with_triangles);
  known_.triangles_of = mesh;
}

void Room::find_for_additions(Index mesh) {
  // Two additions per filling: the second is for a submesh, or for the tear sides of a mesh.
  const std::size_t fillings =
      make_in_columns(mesh, 1, "triangles", [](Rows rows) { return rows == Rows::mesh_fillings; });
  const std::size_t additions =
      make_in_columns(mesh, 2, "walls and caps", [](Rows rows) { return rows == Rows::additions; });
  known_.additions_of = mesh;
  known_.additions = std::min(fillings, additions / 2);
}

void Room::make_for_welds(std::size_t edges, std::size_t side_changes) {
  const auto make = [&](auto& values, std::size_t more) {
    if (values.capacity() - values.size() < more) grow(values, more, nullptr);
  };
  make(columns_.edit.scars, edges);
  make(columns_.edit.side_changes, side_changes);
}

void Room::make_for_threads(std::size_t count) {
  auto& threads = columns_.edit.threads;
  if (threads.capacity() - threads.size() < count) grow(threads, count, nullptr);
}

void Room::make_for_kept_birth(std::size_t influences) {
  auto& births = columns_.edit.kept_births;
  auto& of_births = columns_.edit.kept_influences;
  if (births.capacity() == births.size()) births.reserve(births.size() + growth(births.size(), 1));
  if (of_births.capacity() - of_births.size() < influences)
    of_births.reserve(of_births.size() + growth(of_births.size(), influences));
}

void Room::make_for_influences(Index mesh, std::size_t more) {
  auto& influences = columns_.meshes[mesh].weights.influences;
  if (influences.capacity() - influences.size() < more) grow(influences, more, nullptr);
}

void Room::find_for_point() {
  known_.points = make_in_columns(0, 1, "points", [](Rows rows) { return rows == Rows::points; });
}

void Room::make_for_tails(const ColumnTails& tails) {
  // Rows that a model of fixed capacity had before an undo fit again; others are not limited.
  const auto make = [](std::size_t more, auto& values) {
    if (values.capacity() - values.size() < more)
      values.reserve(values.size() + growth(values.size(), more));
  };
  for_each_common_column(
      [&](const Column& column, auto&& values, auto&& tail) {
        if (column.is_kept) make(tail.size(), values);
      },
      columns_, tails);
  make(tails.edit.surface.appended.size(), columns_.edit.older_part);
  make(tails.edit.surface.appended.size(), columns_.edit.newest_change);
  for (Index m = 0; m < columns_.meshes.size(); ++m) {
    const MeshColumns& tail_of_mesh = tails.edit.meshes[m];
    make_in_mesh(m, tail_of_mesh.records.size(), tails.meshes[m].weights.influences.size());
    for_each_mesh_column(
        m,
        [&](const Column& column, auto&& values, auto&& tail) {
          if constexpr (!kIsMeshVertices<decltype(values)>)
            if (column.is_kept) make(tail.size(), values);
        },
        columns_, tails);
    make(tail_of_mesh.fillings.size(), columns_.edit.meshes[m].filling_serials);
    make(tail_of_mesh.fillings.size(), columns_.edit.meshes[m].newest_part);
  }
  for (const Addition& addition : tails.edit.additions)
    if (addition.kind == Addition::Kind::tear_sides)
      make_for_tear_sides(addition.mesh, tails.edit.meshes[addition.mesh].records.size());
}

Index Room::influence_count(Index mesh, const Triangle& of) const {
  const SkinWeights& weights = columns_.meshes[mesh].weights;
  std::size_t count = 0;
  for (const Index vertex : of) count += weights.of(vertex).size();
  return static_cast<Index>(count);
}

}  // namespace sunder::tear
