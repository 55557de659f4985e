// Weights that vertices have beside those that they were born with.

#include <algorithm>
#include <array>

#include "tear/surface/mesh_vertices.h"
#include "tear/surface/morph_displacement.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

std::vector<Index> SurfaceEditor::vertex_counts_at(const Mark& mark) const {
  std::vector<Index> counts;
  for (const MeshSizes& sizes : sizes_at(mark)) counts.push_back(sizes.vertices);
  return counts;
}

void SurfaceEditor::describe(const WeightChange& exchanged, ChangeRecord& change) const {
  change = {};
  change.first_point = surface_.point_count();
  std::vector<Index> dirty;
  for (std::size_t begin = 0, end = 0; begin < exchanged.vertices.size(); begin = end) {
    const Index mesh = exchanged.vertices[begin].mesh;
    dirty.clear();
    for (; end < exchanged.vertices.size() && exchanged.vertices[end].mesh == mesh; ++end)
      dirty.push_back(exchanged.vertices[end].vertex);
    MeshChange& of_mesh = change.meshes.emplace_back();
    of_mesh.mesh = mesh;
    of_mesh.first_vertex = character_.meshes[mesh].vertex_count();
    of_mesh.first_triangle = character_.meshes[mesh].triangle_count();
    of_mesh.dirty_vertices = DirtyRanges::covering(dirty);
  }
}

bool SurfaceEditor::is_weighable(Index mesh, Index vertex) const {
  if (vertex < source_.meshes[mesh].vertex_count() || original(mesh, vertex) != VertexRef{mesh, vertex}) return false;
  const Birth& born = birth(mesh, vertex);
  if (born.triangle == kNone) return false;
  return std::count_if(born.barycentric.begin(), born.barycentric.end(), [](double part) { return part > 0; }) > 1;
}

Index SurfaceEditor::keep_born(Index mesh, Index vertex) {
  const Index known = born_at(mesh, vertex);
  if (known != kNone) return known;
  const std::span<const Influence> influences = character_.meshes[mesh].weights.of(vertex);
  make_room_for_born(influences.size());
  born_.push_back({character_.meshes[mesh].positions[vertex], static_cast<Index>(born_influences_.size()),
                   static_cast<Index>(influences.size())});
  born_influences_.insert(born_influences_.end(), influences.begin(), influences.end());
  return static_cast<Index>(born_.size() - 1);
}

void SurfaceEditor::resize_born(Index count) {
  if (count < born_.size()) born_influences_.resize(born_[count].first_influence);
  born_.resize(count);
}

void SurfaceEditor::interpolate_born(const Triangle& corners, const std::array<double, 3>& barycentric, Index mesh) {
  if (std::all_of(corners.begin(), corners.end(), [&](Index corner) { return born_at(mesh, corner) == kNone; })) return;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::array<std::span<const Influence>, 3> of_corners;
  ScratchVector<Influence> mean(&scratch_);
  for (std::size_t k = 0; k < 3; ++k) {
    if (barycentric[k] > 0.0) position += barycentric[k] * born_position(mesh, corners[k]).cast<double>();
    of_corners[k] = born_influences(mesh, corners[k]);
    mean.resize(mean.size() + of_corners[k].size());
  }
  mean.resize(mean_influences(of_corners, barycentric, mean.data()));
  Mesh& of = character_.meshes[mesh];
  set_position_and_influences(position.cast<float>(), mean, of.vertex_count() - 1, of);
}

void SurfaceEditor::exchange(WeightChange& change) {
  // What they had, as the change that takes this one back; and the influences from the first that changes in each mesh.
  WeightChange before;
  before.vertices.reserve(change.vertices.size());
  std::vector<Influence> tail;
  std::size_t longest_tail = 0;
  for (std::size_t begin = 0, end = 0; begin < change.vertices.size(); begin = end) {
    const Index mesh = change.vertices[begin].mesh;
    const SkinWeights& weights = character_.meshes[mesh].weights;
    std::size_t old_count = 0, new_count = 0, exact_vertices = 0, exact_count = 0;
    for (; end < change.vertices.size() && change.vertices[end].mesh == mesh; ++end) {
      const VertexWeights& to = change.vertices[end];
      const auto influences = weights.of(to.vertex);
      before.vertices.push_back({mesh, to.vertex, policy(mesh, to.vertex), character_.meshes[mesh].positions[to.vertex],
                                 static_cast<Index>(before.influences.size()), static_cast<Index>(influences.size()),
                                 born_at(mesh, to.vertex)});
      before.influences.insert(before.influences.end(), influences.begin(), influences.end());
      old_count += influences.size();
      new_count += to.influence_count;
      if (to.policy != WeightPolicy::exact) continue;
      ++exact_vertices;
      exact_count += to.influence_count;
    }
    longest_tail = std::max(longest_tail, weights.influences.size() - weights.first[change.vertices[begin].vertex]);
    if (new_count > old_count) make_room_for_influences(mesh, new_count - old_count);
    reserve_exact(mesh, exact_vertices, exact_count);
  }
  tail.reserve(longest_tail);

  for (std::size_t begin = 0, end = 0; begin < change.vertices.size(); begin = end) {
    const Index mesh = change.vertices[begin].mesh, first = change.vertices[begin].vertex;
    Mesh& of = character_.meshes[mesh];
    SkinWeights& weights = of.weights;
    forget_exact(mesh, first);
    const Index offset = weights.first[first];
    tail.assign(weights.influences.begin() + offset, weights.influences.end());
    weights.influences.resize(offset);
    end = begin;
    for (Index vertex = first, old_begin = offset; vertex < of.vertex_count(); ++vertex) {
      const Index old_end = weights.first[vertex + 1];
      const bool changes =
          end < change.vertices.size() && change.vertices[end].mesh == mesh && change.vertices[end].vertex == vertex;
      if (changes) {
        const VertexWeights& to = change.vertices[end++];
        const auto from = change.influences.begin() + to.first_influence;
        weights.influences.insert(weights.influences.end(), from, from + to.influence_count);
        of.positions[vertex] = to.position;
        VertexRecord& record = records_[mesh][vertex - source_.meshes[mesh].vertex_count()];
        record.policy = to.policy;
        record.born = to.born;
      } else {
        weights.influences.insert(weights.influences.end(), tail.begin() + (old_begin - offset), tail.begin() + (old_end - offset));
      }
      old_begin = old_end;
      weights.first[vertex + 1] = static_cast<Index>(weights.influences.size());
    }
    update_exact(mesh, first);
  }
  room_ = {};
  std::swap(change, before);
}

void SurfaceEditor::add_exactly(double part, Index mesh, Index vertex, std::span<const float> morph_weights,
                                AnimationPoint& point) const {
  if (part == 0.0) return;
  if (const VertexRef first = original(mesh, vertex); is_weighable(first.mesh, first.vertex)) {
    const Birth& born = birth(first.mesh, first.vertex);
    const Triangle& corners = origin_triangle(first.mesh, born.triangle);
    for (std::size_t k = 0; k < 3; ++k) add_exactly(part * born.barycentric[k], first.mesh, corners[k], morph_weights, point);
    return;
  }
  const Mesh& of = character_.meshes[mesh];
  point.add(part, Vec3d(of.positions[vertex].cast<double>()) + morph_displacement(of, vertex, morph_weights),
            of.weights.of(vertex));
}

void SurfaceEditor::describe_exactly(const VertexRef& vertex, std::span<const float> morph_weights, AnimationPoint& point) const {
  point.clear();
  add_exactly(1.0, vertex.mesh, vertex.vertex, morph_weights, point);
}

/// What a bone has a part of at a vertex: the sum over the corners that it lies between of their parts times w a, where `value` is
/// a(mesh, vertex).
template <class Value>
Eigen::Vector3d SurfaceEditor::moved_by(Index slot, const VertexRef& vertex, bool follows_original, Value value) const {
  const VertexRef first = original(vertex.mesh, vertex.vertex), of = follows_original ? first : vertex;
  const Mesh& mesh = character_.meshes[of.mesh];
  const auto is_own_corner = [&] {  // the rim of a wall or cap has directions of its own
    const Birth& born = birth(of.mesh, of.vertex);
    if (born.triangle == kNone) return true;  // that no triangle came to use
    const Triangle& corners = origin_triangle(of.mesh, born.triangle);
    return std::find(corners.begin(), corners.end(), of.vertex) != corners.end();
  };
  if (!is_weighable(first.mesh, first.vertex) || is_own_corner()) {
    for (const Influence& influence : mesh.weights.of(of.vertex))
      if (influence.slot == slot) return static_cast<double>(influence.weight) * value(mesh, of.vertex);
    return Eigen::Vector3d::Zero();
  }
  const Birth& born = birth(of.mesh, of.vertex);
  const Triangle& corners = origin_triangle(of.mesh, born.triangle);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    if (born.barycentric[k] > 0.0) sum += born.barycentric[k] * moved_by(slot, {of.mesh, corners[k]}, follows_original, value);
  return sum;
}

void SurfaceEditor::append_exact(Index mesh, Index vertex) {
  const Mesh& of = character_.meshes[mesh];
  InfluencePositions& exact = exact_[mesh];
  exact_first_[mesh].push_back(static_cast<Index>(exact.positions.size()));
  exact.vertices.push_back(vertex);
  exact.morph_targets.resize(of.morph_targets.size());
  const auto add = [&](Index slot, bool is_of_point, std::vector<Vec3f>& values, auto value) {
    values.emplace_back(moved_by(slot, {mesh, vertex}, is_of_point, value).template cast<float>());
  };
  for (const Influence& influence : of.weights.of(vertex)) {
    // Places are those of the point, the same bits at all vertices that share it; directions are the vertex' own.
    add(influence.slot, true, exact.positions,
        [](const Mesh& m, Index v) -> Eigen::Vector3d { return m.positions[v].cast<double>(); });
    if (!of.normals.empty())
      add(influence.slot, false, exact.normals,
          [](const Mesh& m, Index v) -> Eigen::Vector3d { return m.normals[v].cast<double>(); });
    if (!of.tangents.empty())
      add(influence.slot, false, exact.tangents,
          [](const Mesh& m, Index v) -> Eigen::Vector3d { return m.tangents[v].head<3>().cast<double>(); });
    for (std::size_t j = 0; j < of.morph_targets.size(); ++j) {
      const auto add_deltas = [&](bool is_of_point, auto from, std::vector<Vec3f>& values) {
        if ((of.morph_targets[j].*from).empty()) return;
        add(influence.slot, is_of_point, values, [&](const Mesh& m, Index v) -> Eigen::Vector3d {
          const bool has = j < m.morph_targets.size() && !(m.morph_targets[j].*from).empty();
          return has ? (m.morph_targets[j].*from)[v].template cast<double>().eval() : Eigen::Vector3d(Eigen::Vector3d::Zero());
        });
      };
      add_deltas(true, &MorphTarget::position_deltas, exact.morph_targets[j].positions);
      add_deltas(false, &MorphTarget::normal_deltas, exact.morph_targets[j].normals);
      add_deltas(false, &MorphTarget::tangent_deltas, exact.morph_targets[j].tangents);
    }
  }
}

void SurfaceEditor::reserve_exact(Index mesh, std::size_t vertices, std::size_t influences) {
  if (vertices == 0) return;
  const Mesh& of = character_.meshes[mesh];
  InfluencePositions& exact = exact_[mesh];
  const auto reserve = [](auto& values, std::size_t more) {
    if (values.capacity() - values.size() < more) values.reserve(values.size() + more + values.size() / 8);
  };
  reserve(exact.vertices, vertices);
  reserve(exact_first_[mesh], vertices);
  reserve(exact.positions, influences);
  if (!of.normals.empty()) reserve(exact.normals, influences);
  if (!of.tangents.empty()) reserve(exact.tangents, influences);
  exact.morph_targets.resize(of.morph_targets.size());
  for (std::size_t j = 0; j < of.morph_targets.size(); ++j) {
    if (!of.morph_targets[j].position_deltas.empty()) reserve(exact.morph_targets[j].positions, influences);
    if (!of.morph_targets[j].normal_deltas.empty()) reserve(exact.morph_targets[j].normals, influences);
    if (!of.morph_targets[j].tangent_deltas.empty()) reserve(exact.morph_targets[j].tangents, influences);
  }
}

void SurfaceEditor::forget_exact(Index mesh, Index first) {
  InfluencePositions& exact = exact_[mesh];
  const auto kept = std::lower_bound(exact.vertices.begin(), exact.vertices.end(), first) - exact.vertices.begin();
  if (kept == std::ssize(exact.vertices)) return;
  const std::size_t places = exact_first_[mesh][static_cast<std::size_t>(kept)];
  exact.vertices.resize(static_cast<std::size_t>(kept));
  exact_first_[mesh].resize(static_cast<std::size_t>(kept));
  const auto cut = [&](std::vector<Vec3f>& values) {
    if (!values.empty()) values.resize(places);
  };
  cut(exact.positions);
  cut(exact.normals);
  cut(exact.tangents);
  for (InfluencePositions::Deltas& deltas : exact.morph_targets) {
    cut(deltas.positions);
    cut(deltas.normals);
    cut(deltas.tangents);
  }
}

void SurfaceEditor::update_exact(Index mesh, Index first) {
  forget_exact(mesh, first);
  const Index source_count = source_.meshes[mesh].vertex_count();
  for (Index vertex = std::max(first, source_count); vertex < character_.meshes[mesh].vertex_count(); ++vertex)
    if (records_[mesh][vertex - source_count].policy == WeightPolicy::exact) append_exact(mesh, vertex);
}

}  // namespace sunder::tear
