#include "tear/surface/weight_change.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// The part of a change that concerns one mesh, from `begin` on.
std::span<const VertexWeights> part_of_mesh(const WeightChange& change, std::size_t begin) {
  std::size_t end = begin;
  while (end < change.vertices.size() && change.vertices[end].mesh == change.vertices[begin].mesh)
    ++end;
  return std::span(change.vertices).subspan(begin, end - begin);
}

/// By how much the influences grow at most while they are rewritten, from the first vertex on.
std::size_t growth_of(std::span<const VertexWeights> to, const Mesh& mesh) {
  std::size_t growth = 0;
  for (const VertexWeights& vertex : to) {
    const std::size_t before = mesh.weights.of(vertex.vertex).size();
    if (vertex.influence_count > before) growth += vertex.influence_count - before;
  }
  return growth;
}

/// Appends the current weights of the vertices to the spare memory of a change, and makes room for
/// the new ones.
void keep_and_make_room(std::span<const VertexWeights> to, SurfaceEditor& editor,
                        WeightChange& change) {
  const Index mesh = to.front().mesh;
  const Mesh& of = editor.character().meshes[mesh];
  std::size_t exact_vertices = 0, exact_count = 0;
  for (const VertexWeights& vertex : to) {
    const auto influences = of.weights.of(vertex.vertex);
    change.spare_vertices.push_back(
        {mesh, vertex.vertex, editor.births.policy(mesh, vertex.vertex),
         of.positions[vertex.vertex], static_cast<Index>(change.spare_influences.size()),
         static_cast<Index>(influences.size()), editor.births.kept_birth(mesh, vertex.vertex)});
    change.spare_influences.insert(change.spare_influences.end(), influences.begin(),
                                   influences.end());
    if (vertex.policy != WeightPolicy::exact) continue;
    ++exact_vertices;
    exact_count += vertex.influence_count;
  }
  editor.room.make_for_influences(mesh, growth_of(to, of));
  editor.exact.reserve(mesh, exact_vertices, exact_count);
}

/// Rewrites the influences from the first vertex on in place: they are moved back, by as much as
/// what is written may be ahead of what is read.
void write_weights(std::span<const VertexWeights> to, const std::vector<Influence>& influences,
                   SurfaceEditor& editor) {
  const Index mesh = to.front().mesh, first = to.front().vertex;
  Mesh& of = editor.mutable_mesh(mesh);
  SkinWeights& weights = of.weights;
  std::vector<Influence>& all = weights.influences;
  const std::size_t growth = growth_of(to, of), old_size = all.size();
  all.resize(old_size + growth);
  std::move_backward(all.begin() + weights.first[first],
                     all.begin() + static_cast<std::ptrdiff_t>(old_size), all.end());
  auto next = to.begin();
  auto read = all.begin() + static_cast<std::ptrdiff_t>(weights.first[first] + growth),
       written = all.begin() + weights.first[first];
  Index old_begin = weights.first[first];
  for (Index vertex = first; vertex < of.vertex_count(); ++vertex) {
    const Index old_end = weights.first[vertex + 1];
    const auto read_end = read + (old_end - old_begin);
    if (next != to.end() && next->vertex == vertex) {
      written =
          std::copy_n(influences.begin() + next->first_influence, next->influence_count, written);
      of.positions[vertex] = next->position;
      editor.births.set_policy(mesh, vertex, next->policy, next->kept_birth);
      ++next;
    } else {
      written = written == read ? read_end : std::copy(read, read_end, written);
    }
    read = read_end;
    old_begin = old_end;
    weights.first[vertex + 1] = static_cast<Index>(written - all.begin());
  }
  all.erase(written, all.end());
}

}  // namespace

void exchange_weights(WeightChange& change, SurfaceEditor& editor) {
  change.spare_vertices.clear();
  change.spare_influences.clear();
  change.spare_vertices.reserve(change.vertices.size());
  for (std::size_t begin = 0; begin < change.vertices.size();) {
    const std::span<const VertexWeights> part = part_of_mesh(change, begin);
    keep_and_make_room(part, editor, change);
    begin += part.size();
  }
  // From here on nothing allocates.
  for (std::size_t begin = 0; begin < change.vertices.size();) {
    const std::span<const VertexWeights> part = part_of_mesh(change, begin);
    const Index mesh = part.front().mesh, first = part.front().vertex;
    editor.exact.forget_from(mesh, first);
    write_weights(part, change.influences, editor);
    editor.exact.update_from(mesh, first);
    begin += part.size();
  }
  editor.room.forget();
  change.vertices.swap(change.spare_vertices);
  change.influences.swap(change.spare_influences);
}

void describe_weights(const WeightChange& exchanged, const SurfaceEditor& editor,
                      ChangeRecord& change) {
  change = {};
  change.first_point = editor.surface().point_count();
  std::vector<Index> dirty;
  for (std::size_t begin = 0; begin < exchanged.vertices.size();) {
    const std::span<const VertexWeights> part = part_of_mesh(exchanged, begin);
    dirty.clear();
    for (const VertexWeights& vertex : part) dirty.push_back(vertex.vertex);
    const Mesh& mesh = editor.character().meshes[part.front().mesh];
    MeshChange& of_mesh = change.meshes.emplace_back();
    of_mesh.mesh = part.front().mesh;
    of_mesh.first_vertex = mesh.vertex_count();
    of_mesh.first_triangle = mesh.triangle_count();
    of_mesh.dirty_vertices = DirtyRanges::covering(dirty);
    begin += part.size();
  }
}

}  // namespace sunder::tear
