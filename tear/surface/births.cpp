#include "tear/surface/births.h"

#include <algorithm>

#include "tear/surface/morph_displacement.h"

namespace sunder::tear {

std::array<double, 3> Births::place_in_origin(const TriangleRef& ref, Index vertex) const {
  const Triangle& origin = fillings_.origin_triangle(ref.mesh, ref.source_triangle);
  if (vertex < source_.meshes[ref.mesh].vertex_count())
    return {vertex == origin[0] ? 1.0 : 0.0, vertex == origin[1] ? 1.0 : 0.0,
            vertex == origin[2] ? 1.0 : 0.0};
  const Birth& birth = at(ref.mesh, vertex);
  if (birth.triangle == ref.source_triangle) return birth.barycentric;
  // Parts of two origins share a vertex only where the origins share its parents.
  const Triangle& parents = fillings_.origin_triangle(ref.mesh, birth.triangle);
  std::array<double, 3> result = {0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      result[i] += parents[k] == origin[i] ? birth.barycentric[k] : 0.0;
  return result;
}

bool Births::is_weighable(Index mesh, Index vertex) const {
  if (vertex < source_.meshes[mesh].vertex_count() ||
      original(mesh, vertex) != VertexRef{mesh, vertex})
    return false;
  const Birth& birth = at(mesh, vertex);
  if (birth.triangle == kNone) return false;
  return std::count_if(birth.barycentric.begin(), birth.barycentric.end(),
                       [](double part) { return part > 0; }) > 1;
}

void Births::add_exactly(double part, Index mesh, Index vertex,
                         std::span<const float> morph_weights, AnimationPoint& point) const {
  if (part == 0.0) return;
  if (const VertexRef first = original(mesh, vertex); is_weighable(first.mesh, first.vertex)) {
    const Birth& birth = at(first.mesh, first.vertex);
    const Triangle& corners = fillings_.origin_triangle(first.mesh, birth.triangle);
    for (std::size_t k = 0; k < 3; ++k)
      add_exactly(part * birth.barycentric[k], first.mesh, corners[k], morph_weights, point);
    return;
  }
  const Mesh& of = character_.meshes[mesh];
  point.add(
      part,
      Vec3d(of.positions[vertex].cast<double>()) + morph_displacement(of, vertex, morph_weights),
      of.weights.of(vertex));
}

void Births::describe_exactly(const VertexRef& vertex, std::span<const float> morph_weights,
                              AnimationPoint& point) const {
  point.clear();
  add_exactly(1.0, vertex.mesh, vertex.vertex, morph_weights, point);
}

void Births::push(Index mesh, const Birth& birth, const VertexRecord& record) {
  columns_.meshes[mesh].births.push_back(birth);
  columns_.meshes[mesh].records.push_back(record);
  columns_.vertex_mesh.push_back(mesh);
}

Index Births::append(Index mesh, const Birth& birth) {
  Mesh& of = character_.meshes[mesh];
  const Triangle& corners = fillings_.origin_triangle(mesh, birth.triangle);
  push(mesh, birth, {{mesh, of.vertex_count()}});
  const Index vertex = append_interpolated_vertex(corners, birth.barycentric, of);
  if (birth.triangle >= source_.meshes[mesh].triangle_count())
    interpolate_newest(corners, birth.barycentric, mesh);
  return vertex;
}

/// The corners of a filling may have other weights than those that they were born with.
void Births::interpolate_newest(const Triangle& corners, const std::array<double, 3>& barycentric,
                                Index mesh) {
  if (std::all_of(corners.begin(), corners.end(),
                  [&](Index corner) { return kept_birth(mesh, corner) == kNone; }))
    return;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::array<std::span<const Influence>, 3> of_corners;
  ScratchVector<Influence> mean(&scratch_);
  for (std::size_t k = 0; k < 3; ++k) {
    if (barycentric[k] > 0.0) place += barycentric[k] * position(mesh, corners[k]).cast<double>();
    of_corners[k] = influences(mesh, corners[k]);
    mean.resize(mean.size() + of_corners[k].size());
  }
  mean.resize(mean_influences(of_corners, barycentric, mean.data()));
  Mesh& of = character_.meshes[mesh];
  set_position_and_influences(place.cast<float>(), mean, of.vertex_count() - 1, of);
}

Index Births::append_duplicate(Index mesh, Index vertex, const TriangleRef& triangle) {
  const bool is_of_source = vertex < source_.meshes[mesh].vertex_count();
  const Birth birth = is_of_source
                          ? Birth{triangle.source_triangle, place_in_origin(triangle, vertex)}
                          : at(mesh, vertex);
  push(mesh, birth, record(mesh, vertex));
  return append_vertex_copy(vertex, character_.meshes[mesh]);
}

Index Births::append_rim_vertex(Index mesh, const VertexRef& like) {
  Mesh& of = character_.meshes[mesh];
  const Mesh& of_like = character_.meshes[like.mesh];
  const Index attributes_of = like.mesh == mesh ? like.vertex : 0;
  room_.make_for_vertices(mesh, 1,
                          static_cast<Index>(of_like.weights.of(like.vertex).size() +
                                             of.weights.of(attributes_of).size()));
  push(mesh, {kNone, {1, 0, 0}}, record(like.mesh, like.vertex));
  const Index vertex = append_vertex_copy(attributes_of, of);
  if (like.mesh != mesh) copy_surface_point(of_like, like.vertex, vertex, of);
  return vertex;
}

Index Births::append_filling_vertex(Index mesh, Index like) {
  Mesh& of = character_.meshes[mesh];
  room_.make_for_vertices(
      mesh, 1, static_cast<Index>(influences(mesh, like).size() + of.weights.of(like).size()));
  push(mesh, {kNone, {1, 0, 0}}, {{mesh, of.vertex_count()}});
  const Index vertex = append_vertex_copy(like, of);
  if (kept_birth(mesh, like) != kNone)
    set_position_and_influences(position(mesh, like), influences(mesh, like), vertex, of);
  return vertex;
}

bool Births::give_birth(Index mesh, Index vertex, Index filling, Index corner) {
  Birth& birth = columns_.meshes[mesh].births[vertex - source_.meshes[mesh].vertex_count()];
  if (birth.triangle != kNone) return false;
  birth = {filling, {0, 0, 0}};
  birth.barycentric[corner] = 1;
  return true;
}

void Births::remove_newest(Index mesh) {
  columns_.meshes[mesh].births.pop_back();
  columns_.meshes[mesh].records.pop_back();
  columns_.vertex_mesh.pop_back();
  remove_vertices_from(character_.meshes[mesh].vertex_count() - 1, character_.meshes[mesh]);
}

Index Births::keep(Index mesh, Index vertex) {
  const Index known = kept_birth(mesh, vertex);
  if (known != kNone) return known;
  const std::span<const Influence> influences = character_.meshes[mesh].weights.of(vertex);
  room_.make_for_kept_birth(influences.size());
  auto& pool = columns_.kept_influences;
  columns_.kept_births.push_back({character_.meshes[mesh].positions[vertex],
                                  static_cast<Index>(pool.size()),
                                  static_cast<Index>(influences.size())});
  pool.insert(pool.end(), influences.begin(), influences.end());
  return static_cast<Index>(columns_.kept_births.size() - 1);
}

}  // namespace sunder::tear
