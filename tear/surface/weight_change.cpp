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

/// Appends the current weights of the vertices, and makes room for the new ones.
void keep_and_make_room(std::span<const VertexWeights> to, SurfaceEditor& editor,
                        WeightChange& before) {
  const Index mesh = to.front().mesh;
  const Mesh& of = editor.character().meshes[mesh];
  std::size_t old_count = 0, new_count = 0, exact_vertices = 0, exact_count = 0;
  for (const VertexWeights& vertex : to) {
    const auto influences = of.weights.of(vertex.vertex);
    before.vertices.push_back(
        {mesh, vertex.vertex, editor.births.policy(mesh, vertex.vertex),
         of.positions[vertex.vertex], static_cast<Index>(before.influences.size()),
         static_cast<Index>(influences.size()), editor.births.kept_birth(mesh, vertex.vertex)});
    before.influences.insert(before.influences.end(), influences.begin(), influences.end());
    old_count += influences.size();
    new_count += vertex.influence_count;
    if (vertex.policy != WeightPolicy::exact) continue;
    ++exact_vertices;
    exact_count += vertex.influence_count;
  }
  if (new_count > old_count) editor.room.make_for_influences(mesh, new_count - old_count);
  editor.exact.reserve(mesh, exact_vertices, exact_count);
}

/// @param tail  memory for the influences from the first vertex that changes.
void write_weights(std::span<const VertexWeights> to, const std::vector<Influence>& influences,
                   SurfaceEditor& editor, std::vector<Influence>& tail) {
  const Index mesh = to.front().mesh, first = to.front().vertex;
  Mesh& of = editor.mutable_mesh(mesh);
  SkinWeights& weights = of.weights;
  const Index offset = weights.first[first];
  tail.assign(weights.influences.begin() + offset, weights.influences.end());
  weights.influences.resize(offset);
  auto next = to.begin();
  for (Index vertex = first, old_begin = offset; vertex < of.vertex_count(); ++vertex) {
    const Index old_end = weights.first[vertex + 1];
    if (next != to.end() && next->vertex == vertex) {
      const auto from = influences.begin() + next->first_influence;
      weights.influences.insert(weights.influences.end(), from, from + next->influence_count);
      of.positions[vertex] = next->position;
      editor.births.set_policy(mesh, vertex, next->policy, next->kept_birth);
      ++next;
    } else {
      weights.influences.insert(weights.influences.end(), tail.begin() + (old_begin - offset),
                                tail.begin() + (old_end - offset));
    }
    old_begin = old_end;
    weights.first[vertex + 1] = static_cast<Index>(weights.influences.size());
  }
}

}  // namespace

void exchange_weights(WeightChange& change, SurfaceEditor& editor) {
  WeightChange before;
  before.vertices.reserve(change.vertices.size());
  std::size_t longest_tail = 0;
  for (std::size_t begin = 0; begin < change.vertices.size();) {
    const std::span<const VertexWeights> part = part_of_mesh(change, begin);
    keep_and_make_room(part, editor, before);
    const SkinWeights& weights = editor.character().meshes[part.front().mesh].weights;
    longest_tail =
        std::max(longest_tail, weights.influences.size() - weights.first[part.front().vertex]);
    begin += part.size();
  }
  std::vector<Influence> tail;
  tail.reserve(longest_tail);

  for (std::size_t begin = 0; begin < change.vertices.size();) {
    const std::span<const VertexWeights> part = part_of_mesh(change, begin);
    const Index mesh = part.front().mesh, first = part.front().vertex;
    editor.exact.forget_from(mesh, first);
    write_weights(part, change.influences, editor, tail);
    editor.exact.update_from(mesh, first);
    begin += part.size();
  }
  editor.room.forget();
  std::swap(change, before);
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
