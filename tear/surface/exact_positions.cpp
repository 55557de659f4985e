#include "tear/surface/exact_positions.h"

#include <algorithm>

namespace sunder::tear {

/// The part of a vertex that follows a bone: the sum over the corners that it lies between of their
/// barycentric coordinate times weight times value(mesh, vertex).
template <class Value>
Eigen::Vector3d ExactPositions::moved_by(Index slot, const VertexRef& vertex, bool follows_original,
                                         Value value) const {
  const VertexRef first = births_.original(vertex.mesh, vertex.vertex),
                  of = follows_original ? first : vertex;
  const Mesh& mesh = character_.meshes[of.mesh];
  const auto is_own_corner = [&] {  // the rim of a wall or cap has directions of its own
    const Birth& born = births_.at(of.mesh, of.vertex);
    if (born.triangle == kNone) return true;  // not used by a triangle yet
    const Triangle& corners = fillings_.origin_triangle(of.mesh, born.triangle);
    return std::find(corners.begin(), corners.end(), of.vertex) != corners.end();
  };
  if (!births_.is_weighable(first.mesh, first.vertex) || is_own_corner()) {
    for (const Influence& influence : mesh.weights.of(of.vertex))
      if (influence.slot == slot)
        return static_cast<double>(influence.weight) * value(mesh, of.vertex);
    return Eigen::Vector3d::Zero();
  }
  const Birth& born = births_.at(of.mesh, of.vertex);
  const Triangle& corners = fillings_.origin_triangle(of.mesh, born.triangle);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    if (born.barycentric[k] > 0.0)
      sum += born.barycentric[k] * moved_by(slot, {of.mesh, corners[k]}, follows_original, value);
  return sum;
}

void ExactPositions::append(Index mesh, Index vertex) {
  const Mesh& of = character_.meshes[mesh];
  InfluencePositions& exact = exact_[mesh];
  first_[mesh].push_back(static_cast<Index>(exact.positions.size()));
  exact.vertices.push_back(vertex);
  exact.morph_targets.resize(of.morph_targets.size());
  const auto add = [&](Index slot, bool is_of_point, std::vector<Vec3f>& values, auto value) {
    values.emplace_back(moved_by(slot, {mesh, vertex}, is_of_point, value).template cast<float>());
  };
  for (const Influence& influence : of.weights.of(vertex)) {
    // Positions are those of the point, with the same bits for all vertices that share it;
    // directions are the vertex' own.
    add(influence.slot, true, exact.positions,
        [](const Mesh& m, Index v) -> Eigen::Vector3d { return m.positions[v].cast<double>(); });
    if (!of.normals.empty())
      add(influence.slot, false, exact.normals,
          [](const Mesh& m, Index v) -> Eigen::Vector3d { return m.normals[v].cast<double>(); });
    if (!of.tangents.empty())
      add(influence.slot, false, exact.tangents, [](const Mesh& m, Index v) -> Eigen::Vector3d {
        return m.tangents[v].head<3>().cast<double>();
      });
    for (std::size_t j = 0; j < of.morph_targets.size(); ++j) {
      const auto add_deltas = [&](bool is_of_point, auto from, std::vector<Vec3f>& values) {
        if ((of.morph_targets[j].*from).empty()) return;
        add(influence.slot, is_of_point, values, [&](const Mesh& m, Index v) -> Eigen::Vector3d {
          const bool has = j < m.morph_targets.size() && !(m.morph_targets[j].*from).empty();
          return has ? (m.morph_targets[j].*from)[v].template cast<double>().eval()
                     : Eigen::Vector3d(Eigen::Vector3d::Zero());
        });
      };
      add_deltas(true, &MorphTarget::position_deltas, exact.morph_targets[j].positions);
      add_deltas(false, &MorphTarget::normal_deltas, exact.morph_targets[j].normals);
      add_deltas(false, &MorphTarget::tangent_deltas, exact.morph_targets[j].tangents);
    }
  }
}

void ExactPositions::reserve(Index mesh, std::size_t vertices, std::size_t influences) {
  if (vertices == 0) return;
  const Mesh& of = character_.meshes[mesh];
  InfluencePositions& exact = exact_[mesh];
  const auto reserve = [](auto& values, std::size_t more) {
    if (values.capacity() - values.size() < more)
      values.reserve(values.size() + more + values.size() / 8);
  };
  reserve(exact.vertices, vertices);
  reserve(first_[mesh], vertices);
  reserve(exact.positions, influences);
  if (!of.normals.empty()) reserve(exact.normals, influences);
  if (!of.tangents.empty()) reserve(exact.tangents, influences);
  exact.morph_targets.resize(of.morph_targets.size());
  for (std::size_t j = 0; j < of.morph_targets.size(); ++j) {
    if (!of.morph_targets[j].position_deltas.empty())
      reserve(exact.morph_targets[j].positions, influences);
    if (!of.morph_targets[j].normal_deltas.empty())
      reserve(exact.morph_targets[j].normals, influences);
    if (!of.morph_targets[j].tangent_deltas.empty())
      reserve(exact.morph_targets[j].tangents, influences);
  }
}

void ExactPositions::forget_from(Index mesh, Index first) {
  InfluencePositions& exact = exact_[mesh];
  const auto kept = std::lower_bound(exact.vertices.begin(), exact.vertices.end(), first) -
                    exact.vertices.begin();
  if (kept == std::ssize(exact.vertices)) return;
  const std::size_t places = first_[mesh][static_cast<std::size_t>(kept)];
  exact.vertices.resize(static_cast<std::size_t>(kept));
  first_[mesh].resize(static_cast<std::size_t>(kept));
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

void ExactPositions::update_from(Index mesh, Index first) {
  forget_from(mesh, first);
  const Mesh& of = character_.meshes[mesh];
  const Index source_count = source_.meshes[mesh].vertex_count();
  const auto for_each_exact = [&](auto visit) {
    for (Index vertex = std::max(first, source_count); vertex < of.vertex_count(); ++vertex)
      if (columns_.meshes[mesh].records[vertex - source_count].policy == WeightPolicy::exact)
        visit(vertex);
  };
  std::size_t vertices = 0, influences = 0;
  for_each_exact([&](Index vertex) {
    ++vertices;
    influences += of.weights.of(vertex).size();
  });
  reserve(mesh, vertices, influences);  // so that no vertex is left half appended
  for_each_exact([&](Index vertex) { append(mesh, vertex); });
}

}  // namespace sunder::tear
