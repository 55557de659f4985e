#include "tear/internal/mesh_vertices.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/assign_with_room.h"

namespace sunder {
namespace {

/// The corners of a new vertex, and the sums over them.
struct Corners {
  Triangle vertices;
  std::array<double, 3> barycentric;

  template <int N>
  [[nodiscard]] Eigen::Matrix<double, N, 1> mean(
      const std::vector<Eigen::Matrix<float, N, 1, Eigen::DontAlign>>& values) const {
    Eigen::Matrix<double, N, 1> sum = Eigen::Matrix<double, N, 1>::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      if (barycentric[k] > 0.0) sum += barycentric[k] * values[vertices[k]].template cast<double>();
    return sum;
  }

  [[nodiscard]] std::uint32_t nearest_vertex() const {
    const auto largest = std::max_element(barycentric.begin(), barycentric.end());
    return vertices[static_cast<std::size_t>(largest - barycentric.begin())];
  }
};

/// Unit length; if opposite directions cancel, the direction of the nearest corner.
Eigen::Vector3d unit_direction(const Eigen::Vector3d& direction, const Vec3f& nearest) {
  const double length = norm(direction);
  return length > tear::kDirectionLengths ? Eigen::Vector3d(direction / length)
                                          : Eigen::Vector3d(nearest.cast<double>());
}

template <int N>
void append_mean(const Corners& corners,
                 std::vector<Eigen::Matrix<float, N, 1, Eigen::DontAlign>>& values) {
  if (!values.empty()) values.emplace_back(corners.mean(values).template cast<float>());
}

void append_custom(const Corners& corners, CustomAttribute& attribute) {
  const auto value_at = [&](std::uint32_t vertex, std::uint32_t c) {
    return attribute.values[std::size_t{vertex} * attribute.components + c];
  };
  for (std::uint32_t c = 0; c < attribute.components; ++c) {
    if (!attribute.interpolates) {
      attribute.values.push_back(value_at(corners.nearest_vertex(), c));
      continue;
    }
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      if (corners.barycentric[k] > 0.0)
        sum += corners.barycentric[k] * static_cast<double>(value_at(corners.vertices[k], c));
    attribute.values.push_back(static_cast<float>(sum));
  }
}

/// Appended to the pool in place, so that a warm call does not allocate.
void append_mean_weights(const Corners& corners, SkinWeights& weights) {
  std::size_t most = 0;
  for (const std::uint32_t vertex : corners.vertices)
    most += weights.first[vertex + 1] - weights.first[vertex];
  const std::size_t old_size = weights.influences.size();
  weights.influences.resize(old_size + most);
  const std::array<std::span<const Influence>, 3> of_corners = {weights.of(corners.vertices[0]),
                                                                weights.of(corners.vertices[1]),
                                                                weights.of(corners.vertices[2])};
  const std::size_t count =
      mean_influences(of_corners, corners.barycentric, weights.influences.data() + old_size);
  weights.influences.resize(old_size + count);
  weights.first.push_back(static_cast<std::uint32_t>(weights.influences.size()));
}

/// Calls visit(array, entries per vertex) for each per-vertex array but the weights.
template <class AnyMesh, class Visit>
void for_each_array(AnyMesh& mesh, Visit visit) {
  visit(mesh.positions, 1u);
  visit(mesh.normals, 1u);
  visit(mesh.tangents, 1u);
  for (auto& uv : mesh.uv_sets) visit(uv, 1u);
  for (auto& colors : mesh.color_sets) visit(colors, 1u);
  for (auto& attribute : mesh.custom_attributes) visit(attribute.values, attribute.components);
  for (auto& target : mesh.morph_targets) {
    visit(target.position_deltas, 1u);
    visit(target.normal_deltas, 1u);
    visit(target.tangent_deltas, 1u);
  }
}

/// Calls visit(from, to, entries per vertex) for the arrays of two meshes that have the same
/// attributes.
template <class Visit>
void for_each_array_pair(const Mesh& from, Mesh& to, Visit visit) {
  visit(from.positions, to.positions, 1u);
  visit(from.normals, to.normals, 1u);
  visit(from.tangents, to.tangents, 1u);
  for (std::size_t i = 0; i < from.uv_sets.size(); ++i) visit(from.uv_sets[i], to.uv_sets[i], 1u);
  for (std::size_t i = 0; i < from.color_sets.size(); ++i)
    visit(from.color_sets[i], to.color_sets[i], 1u);
  for (std::size_t i = 0; i < from.custom_attributes.size(); ++i)
    visit(from.custom_attributes[i].values, to.custom_attributes[i].values,
          from.custom_attributes[i].components);
  for (std::size_t i = 0; i < from.morph_targets.size(); ++i) {
    visit(from.morph_targets[i].position_deltas, to.morph_targets[i].position_deltas, 1u);
    visit(from.morph_targets[i].normal_deltas, to.morph_targets[i].normal_deltas, 1u);
    visit(from.morph_targets[i].tangent_deltas, to.morph_targets[i].tangent_deltas, 1u);
  }
}

/// Gives a copy the sets of attributes of a mesh, without values.
void copy_attributes(const Mesh& mesh, Mesh& copy) {
  copy.uv_sets.resize(mesh.uv_sets.size());
  copy.color_sets.resize(mesh.color_sets.size());
  copy.custom_attributes.resize(mesh.custom_attributes.size());
  for (std::size_t i = 0; i < mesh.custom_attributes.size(); ++i) {
    copy.custom_attributes[i].name = mesh.custom_attributes[i].name;
    copy.custom_attributes[i].components = mesh.custom_attributes[i].components;
    copy.custom_attributes[i].interpolates = mesh.custom_attributes[i].interpolates;
  }
  copy.morph_targets.resize(mesh.morph_targets.size());
}

}  // namespace

std::size_t mean_influences(const std::array<std::span<const Influence>, 3>& of_corners,
                            const std::array<double, 3>& barycentric, Influence* mean) {
  Influence* const begin = mean;
  Influence* end = begin;
  // The mean is at most a few dozen influences: a linear search for a slot beats any map.
  for (std::size_t k = 0; k < 3; ++k) {
    if (barycentric[k] <= 0.0) continue;
    for (const Influence& influence : of_corners[k]) {
      const auto part = static_cast<float>(barycentric[k] * static_cast<double>(influence.weight));
      if (!(part > 0.0f)) continue;
      Influence* same_slot = begin;
      while (same_slot != end && same_slot->slot != influence.slot) ++same_slot;
      if (same_slot == end)
        *end++ = {influence.slot, part};
      else
        same_slot->weight += part;
    }
  }
  double sum = 0;
  for (const Influence* i = begin; i != end; ++i) sum += static_cast<double>(i->weight);
  for (Influence* i = begin; i != end; ++i)
    i->weight = static_cast<float>(static_cast<double>(i->weight) / sum);
  const auto comes_before = [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.slot < b.slot;
  };
  for (Influence* i = begin; i != end; ++i) {  // insertion sort: a few entries, and nearly in order
    const Influence influence = *i;
    Influence* place = i;
    for (; place != begin && comes_before(influence, *(place - 1)); --place) *place = *(place - 1);
    *place = influence;
  }
  return static_cast<std::size_t>(end - begin);
}

std::uint32_t append_interpolated_vertex(const Triangle& vertices,
                                         const std::array<double, 3>& barycentric, Mesh& mesh) {
  const Corners corners{vertices, barycentric};
  const std::uint32_t nearest = corners.nearest_vertex();
  const std::uint32_t vertex = mesh.vertex_count();
  append_mean(corners, mesh.positions);
  if (!mesh.normals.empty()) {
    const Vec3f of_nearest = mesh.normals[nearest];
    mesh.normals.emplace_back(unit_direction(corners.mean(mesh.normals), of_nearest).cast<float>());
  }
  if (!mesh.tangents.empty()) {
    const Vec4f of_nearest = mesh.tangents[nearest];
    const Eigen::Vector3d mean = corners.mean(mesh.tangents).head<3>();
    const Eigen::Vector3f tangent = unit_direction(mean, of_nearest.head<3>()).cast<float>();
    mesh.tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(), of_nearest.w());
  }
  for (auto& uv : mesh.uv_sets) append_mean(corners, uv);
  for (auto& colors : mesh.color_sets) append_mean(corners, colors);
  for (CustomAttribute& attribute : mesh.custom_attributes) append_custom(corners, attribute);
  for (MorphTarget& target : mesh.morph_targets) {
    append_mean(corners, target.position_deltas);
    append_mean(corners, target.normal_deltas);
    append_mean(corners, target.tangent_deltas);
  }
  append_mean_weights(corners, mesh.weights);
  return vertex;
}

std::uint32_t append_vertex_copy(std::uint32_t vertex, Mesh& mesh) {
  const std::uint32_t copy = mesh.vertex_count();
  for_each_array(mesh, [&](auto& values, std::size_t per_vertex) {
    if (values.empty()) return;
    for (std::size_t c = 0; c < per_vertex; ++c) {
      const auto value = values[vertex * per_vertex + c];  // by value: push_back may move the array
      values.push_back(value);
    }
  });
  auto& pool = mesh.weights.influences;
  for (std::uint32_t i = mesh.weights.first[vertex]; i < mesh.weights.first[vertex + 1]; ++i) {
    const Influence influence = pool[i];
    pool.push_back(influence);
  }
  mesh.weights.first.push_back(static_cast<std::uint32_t>(pool.size()));
  return copy;
}

void copy_surface_point(const Mesh& like_mesh, std::uint32_t like, std::uint32_t vertex,
                        Mesh& mesh) {
  mesh.positions[vertex] = like_mesh.positions[like];
  const std::size_t shared_targets =
      std::min(mesh.morph_targets.size(), like_mesh.morph_targets.size());
  for (std::size_t i = 0; i < shared_targets; ++i)
    if (!mesh.morph_targets[i].position_deltas.empty() &&
        !like_mesh.morph_targets[i].position_deltas.empty())
      mesh.morph_targets[i].position_deltas[vertex] =
          like_mesh.morph_targets[i].position_deltas[like];
  auto& weights = mesh.weights;
  weights.influences.resize(weights.first[vertex]);
  const std::uint32_t begin = like_mesh.weights.first[like],
                      end = like_mesh.weights.first[like + 1];
  for (std::uint32_t i = begin; i < end; ++i) {
    const Influence influence =
        like_mesh.weights.influences[i];  // by value: `mesh` may be `like_mesh`
    weights.influences.push_back(influence);
  }
  weights.first[vertex + 1] = static_cast<std::uint32_t>(weights.influences.size());
}

bool is_same_surface_point(const Mesh& mesh, std::uint32_t vertex, const Mesh& other_mesh,
                           std::uint32_t other) {
  if (mesh.positions[vertex] != other_mesh.positions[other]) return false;
  const std::size_t shared_targets =
      std::min(mesh.morph_targets.size(), other_mesh.morph_targets.size());
  for (std::size_t i = 0; i < shared_targets; ++i) {
    const auto &of = mesh.morph_targets[i].position_deltas,
               &of_other = other_mesh.morph_targets[i].position_deltas;
    if (!of.empty() && !of_other.empty() && of[vertex] != of_other[other]) return false;
  }
  return std::ranges::equal(mesh.weights.of(vertex), other_mesh.weights.of(other));
}

bool is_same_but_for_tear_side(const Mesh& mesh, std::uint32_t vertex, std::uint32_t other) {
  if (vertex == other) return true;
  const auto differs = [&](const auto& values) {
    return !values.empty() && values[vertex] != values[other];
  };
  if (!is_same_surface_point(mesh, vertex, mesh, other) || differs(mesh.normals) ||
      differs(mesh.tangents) || std::ranges::any_of(mesh.uv_sets, differs) ||
      std::ranges::any_of(mesh.color_sets, differs))
    return false;
  const auto custom_differs = [&](const CustomAttribute& attribute) {
    if (attribute.name == kTearSideAttribute) return false;
    const std::size_t count = attribute.components;
    return !std::equal(attribute.values.begin() + std::ptrdiff_t(count * vertex),
                       attribute.values.begin() + std::ptrdiff_t(count * (vertex + 1)),
                       attribute.values.begin() + std::ptrdiff_t(count * other));
  };
  const auto target_differs = [&](const MorphTarget& target) {
    return differs(target.normal_deltas) || differs(target.tangent_deltas);
  };
  return !std::ranges::any_of(mesh.custom_attributes, custom_differs) &&
         !std::ranges::any_of(mesh.morph_targets, target_differs);
}

void set_position_and_influences(const Vec3f& position, std::span<const Influence> influences,
                                 std::uint32_t vertex, Mesh& mesh) {
  mesh.positions[vertex] = position;
  SkinWeights& weights = mesh.weights;
  weights.influences.resize(weights.first[vertex]);
  weights.influences.insert(weights.influences.end(), influences.begin(), influences.end());
  weights.first[vertex + 1] = static_cast<std::uint32_t>(weights.influences.size());
}

std::size_t room_for_vertices(const Mesh& mesh) {
  std::size_t room = mesh.weights.first.capacity() - mesh.weights.first.size();
  for_each_array(mesh, [&](const auto& values, std::size_t per_vertex) {
    if (!values.empty()) room = std::min(room, (values.capacity() - values.size()) / per_vertex);
  });
  return room;
}

void reserve_vertices(std::size_t vertex_count, std::size_t influence_count, Mesh& mesh) {
  for_each_array(mesh, [&](auto& values, std::size_t per_vertex) {
    if (!values.empty()) values.reserve(values.size() + vertex_count * per_vertex);
  });
  mesh.weights.first.reserve(mesh.weights.first.size() + vertex_count);
  mesh.weights.influences.reserve(mesh.weights.influences.size() + influence_count);
}

void remove_vertices_from(std::uint32_t vertex_count, Mesh& mesh) {
  for_each_array(mesh, [&](auto& values, std::size_t per_vertex) {
    if (!values.empty()) values.resize(vertex_count * per_vertex);
  });
  mesh.weights.first.resize(vertex_count + 1);
  mesh.weights.influences.resize(mesh.weights.first.back());
}

Mesh copy_with_room(const Mesh& mesh, const VertexRoom& room, std::size_t triangle_count) {
  Mesh copy;
  copy.name = mesh.name;
  copy.skin = mesh.skin;
  copy.first_morph_weight = mesh.first_morph_weight;
  copy.submeshes = mesh.submeshes;
  copy_attributes(mesh, copy);
  for (std::size_t i = 0; i < mesh.morph_targets.size(); ++i)
    copy.morph_targets[i].name = mesh.morph_targets[i].name;
  for_each_array_pair(mesh, copy, [&](const auto& from, auto& to, std::size_t per_vertex) {
    if (!from.empty()) assign_with_room(from, room.vertices * per_vertex, to);
  });
  assign_with_room(mesh.weights.first, room.vertices, copy.weights.first);
  assign_with_room(mesh.weights.influences, room.influences, copy.weights.influences);
  assign_with_room(mesh.triangles, triangle_count, copy.triangles);
  assign_with_room(mesh.triangle_submesh, triangle_count, copy.triangle_submesh);
  return copy;
}

void copy_vertices_from(std::uint32_t first_vertex, const Mesh& mesh, Mesh& tail) {
  copy_attributes(mesh, tail);
  for_each_array_pair(mesh, tail, [&](const auto& from, auto& to, std::size_t per_vertex) {
    if (from.empty())
      to.clear();
    else
      to.assign(from.begin() + static_cast<std::ptrdiff_t>(first_vertex * per_vertex), from.end());
  });
  const std::uint32_t begin = mesh.weights.first[first_vertex];
  tail.weights.first.clear();
  for (std::size_t v = first_vertex; v < mesh.weights.first.size(); ++v)
    tail.weights.first.push_back(mesh.weights.first[v] - begin);
  tail.weights.influences.assign(mesh.weights.influences.begin() + begin,
                                 mesh.weights.influences.end());
}

void append_vertices(const Mesh& tail, Mesh& mesh) {
  for_each_array_pair(tail, mesh, [](const auto& from, auto& to, std::size_t) {
    to.insert(to.end(), from.begin(), from.end());
  });
  const auto begin = static_cast<std::uint32_t>(mesh.weights.influences.size());
  for (std::size_t v = 1; v < tail.weights.first.size(); ++v)
    mesh.weights.first.push_back(begin + tail.weights.first[v]);
  mesh.weights.influences.insert(mesh.weights.influences.end(), tail.weights.influences.begin(),
                                 tail.weights.influences.end());
}

}  // namespace sunder
