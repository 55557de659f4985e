#include "support/oracles/torn_invariants.h"

#include <sunder/tear/topology.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <map>
#include <set>

#include "support/machine/say.h"
#include "support/oracles/source_cover.h"
#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

template <class T>
bool starts_with(const std::vector<T>& grown, const std::vector<T>& source) {
  return grown.size() >= source.size() &&
         (source.empty() ||
          std::memcmp(grown.data(), source.data(), source.size() * sizeof(T)) == 0);
}

bool keeps_source_vertices(const Mesh& torn, const Mesh& source) {
  bool same = starts_with(torn.positions, source.positions) &&
              starts_with(torn.normals, source.normals) &&
              starts_with(torn.tangents, source.tangents) &&
              starts_with(torn.weights.first, source.weights.first) &&
              starts_with(torn.weights.influences, source.weights.influences) &&
              torn.uv_sets.size() == source.uv_sets.size() &&
              torn.color_sets.size() == source.color_sets.size() &&
              torn.morph_targets.size() == source.morph_targets.size();
  for (std::size_t i = 0; same && i < source.uv_sets.size(); ++i)
    same = starts_with(torn.uv_sets[i], source.uv_sets[i]);
  for (std::size_t i = 0; same && i < source.color_sets.size(); ++i)
    same = starts_with(torn.color_sets[i], source.color_sets[i]);
  for (std::size_t i = 0; same && i < source.morph_targets.size(); ++i)
    same =
        starts_with(torn.morph_targets[i].position_deltas,
                    source.morph_targets[i].position_deltas) &&
        starts_with(torn.morph_targets[i].normal_deltas, source.morph_targets[i].normal_deltas) &&
        starts_with(torn.morph_targets[i].tangent_deltas, source.morph_targets[i].tangent_deltas);
  for (std::size_t i = 0; same && i < source.custom_attributes.size(); ++i)
    same = source.custom_attributes[i].name == kTearSideAttribute ||
           starts_with(torn.custom_attributes[i].values, source.custom_attributes[i].values);
  return same;
}

/// The parts of each triangle of the source, and of each wall and cap as created, cover all of it
/// that was not removed.
void check_cover(const TornModel& model, std::uint32_t m, std::vector<std::string>& faults) {
  const Cover cover = cover_of(model, m);
  for (const std::string& fault : cover.faults) faults.push_back(say("mesh ", m, ": ", fault));
  // A weld brings ends of lips together that differ by a millionth of a triangle.
  const double rounding = scars_of(model).empty() ? 1e-9 : 1e-6;
  for (std::size_t t = 0; t < cover.part.size(); ++t)
    if (cover.part[t] > 1 + rounding || (!cover.has_retired[t] && cover.part[t] < 1 - rounding))
      faults.push_back(
          say("mesh ", m, ": parts of triangle ", t, " cover ", cover.part[t], " of it"));
}

/// Origins of triangles do not change; parts have the submesh of their origin, walls and caps have
/// submeshes of their own, one per name and material.
void check_origins(const TornModel& model, std::uint32_t m, std::vector<std::string>& faults) {
  const Mesh &torn = model.character().meshes[m], &source = model.source().meshes[m];
  std::vector<std::uint32_t> submesh = source.triangle_submesh;
  submesh.resize(source.triangle_count() + model.fillings(m).size(), kNone);
  if (torn.submeshes.size() < source.submeshes.size() ||
      !std::equal(source.submeshes.begin(), source.submeshes.end(), torn.submeshes.begin()))
    faults.push_back(say("mesh ", m, ": a submesh of the source changed"));
  const auto first = torn.submeshes.begin() + std::ssize(source.submeshes);
  for (auto of_fillings = first; of_fillings < torn.submeshes.end(); ++of_fillings)
    if (std::find(first, of_fillings, *of_fillings) != of_fillings)
      faults.push_back(say("mesh ", m, ": two submeshes of fillings have one name and material"));
  for (std::uint32_t t = 0; t < torn.triangle_count(); ++t) {
    const std::uint32_t origin = model.source_triangle(m, t);
    if (origin >= submesh.size()) continue;  // reported by check_cover()
    if (t < source.triangle_count() && origin != t)
      faults.push_back(say("mesh ", m, ": triangle ", t, " changed its source"));
    if (submesh[origin] == kNone) submesh[origin] = torn.triangle_submesh[t];
    if (torn.triangle_submesh[t] != submesh[origin])
      faults.push_back(say("mesh ", m, ": triangle ", t, " changed its submesh"));
    if (origin >= source.triangle_count() && torn.triangle_submesh[t] < source.submeshes.size())
      faults.push_back(
          say("mesh ", m, ": triangle ", t, " of a wall or cap is in a submesh of the source"));
  }
}

/// Vertices of walls and caps are born as their corners.
void check_fillings(const TornModel& model, std::uint32_t m, std::vector<std::string>& faults) {
  const Mesh &torn = model.character().meshes[m], &source = model.source().meshes[m];
  const auto fillings = model.fillings(m);
  const auto is_born_as_corner = [&](std::uint32_t vertex) {
    if (vertex < source.vertex_count() || vertex >= torn.vertex_count()) return false;
    const Birth birth = model.birth(m, vertex);
    if (birth.triangle < source.triangle_count() ||
        birth.triangle - source.triangle_count() >= fillings.size())
      return false;
    const Triangle& in = fillings[birth.triangle - source.triangle_count()];
    for (std::size_t k = 0; k < 3; ++k)
      if (birth.barycentric[k] != (in[k] == vertex ? 1.0 : 0.0)) return false;
    return true;
  };
  for (std::size_t f = 0; f < fillings.size(); ++f)
    for (const std::uint32_t vertex : fillings[f])
      if (!is_born_as_corner(vertex))
        faults.push_back(
            say("mesh ", m, ": vertex ", vertex, " of filling ", f, " is not its own"));
}

/// Triangles with a repeated vertex that the source does not have.
void check_vertices_differ(const TornModel& model, std::uint32_t m,
                           std::vector<std::string>& faults) {
  const Mesh &torn = model.character().meshes[m], &source = model.source().meshes[m];
  for (std::uint32_t t = 0; t < torn.triangle_count(); ++t) {
    const auto& [a, b, c] = torn.triangles[t];
    if (is_retired(torn.triangles[t]) || (a != b && b != c && c != a)) continue;
    const bool was_so = t < source.triangle_count() && torn.triangles[t] == source.triangles[t];
    if (!was_so) faults.push_back(say("mesh ", m, ": triangle ", t, " has a vertex twice"));
  }
}

/// Surface points that have a triangle. Points that lost all their triangles keep their indices.
std::size_t live_point_count(const TornModel& model) {
  std::set<std::uint32_t> points;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3 && !is_retired(mesh.triangles[t]); ++k)
        points.insert(model.point_at(m, t, k));
  }
  return points.size();
}

Character with_lips_closed(const Character& torn) {
  Character closed = torn;
  for (Mesh& mesh : closed.meshes)
    for (CustomAttribute& attribute : mesh.custom_attributes)
      if (attribute.name == kTearSideAttribute)
        std::fill(attribute.values.begin(), attribute.values.end(), 0.0f);
  return closed;
}

}  // namespace

std::vector<std::string> broken_laws(const TornModel& model) {
  std::vector<std::string> faults;
  const Character &torn = model.character(), &source = model.source();
  if (Status status = validate_character(torn); !status)
    faults.push_back(say("not valid: ", status.text()));
  for (std::uint32_t m = 0; m < torn.meshes.size(); ++m) {
    if (!keeps_source_vertices(torn.meshes[m], source.meshes[m]))
      faults.push_back(say("mesh ", m, ": a source vertex changed"));
    check_cover(model, m, faults);
    check_origins(model, m, faults);
    check_fillings(model, m, faults);
    check_vertices_differ(model, m, faults);
  }
  return faults;
}

std::vector<std::string> broken_surface(const TornModel& model) {
  std::vector<std::string> faults;
  const TopologyCounts before = *count_topology(model.source()),
                       after = *count_topology(model.character());
  if (after.non_manifold_edges > before.non_manifold_edges)
    faults.push_back(
        say("non-manifold edges: ", before.non_manifold_edges, " -> ", after.non_manifold_edges));
  // The surface read from the arrays equals the one of the kernel. If a source edge has many faces,
  // splitting some of them leaves others that would now be joined.
  if (const std::size_t live = live_point_count(model);
      before.non_manifold_edges == 0 && after.points != live)
    faults.push_back(say("arrays describe ", after.points, " points, the kernel has ", live));
  return faults;
}

bool is_clear_of_itself(const Character& source) {
  using At = std::array<float, 3>;
  std::set<At> places;
  std::set<std::array<At, 3>> faces;
  for (const Mesh& mesh : source.meshes)
    for (const Triangle& triangle : mesh.triangles) {
      if (is_retired(triangle)) continue;
      std::array<At, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f& position = mesh.positions[triangle[k]];
        face[k] = {position.x() + 0.0f, position.y() + 0.0f, position.z() + 0.0f};
        places.insert(face[k]);
      }
      std::sort(face.begin(), face.end());
      const bool has_repeated_point = face[0] == face[1] || face[1] == face[2];
      if (!has_repeated_point && !faces.insert(face).second) return false;
    }
  const TopologyCounts counts = *count_topology(source);
  return counts.non_manifold_edges == 0 && counts.points == places.size();
}

std::vector<std::string> broken_closure(const TornModel& model) {
  std::vector<std::string> faults;
  const TopologyCounts before = *count_topology(model.source()),
                       closed = *count_topology(with_lips_closed(model.character()));
  if (closed.components != before.components || closed.boundary_loops != before.boundary_loops ||
      closed.non_manifold_edges != before.non_manifold_edges)
    faults.push_back(say("with lips closed: components ", before.components, " -> ",
                         closed.components, ", boundary loops ", before.boundary_loops, " -> ",
                         closed.boundary_loops, ", non-manifold edges ", before.non_manifold_edges,
                         " -> ", closed.non_manifold_edges));
  return faults;
}

std::vector<std::string> broken_lips(const TornModel& model, const ChangeRecord& change) {
  std::vector<std::string> faults;
  const Character& torn = model.character();
  struct Place {
    std::uint32_t mesh, vertex;
  };
  std::map<std::uint32_t, Place> place_of_point;
  for (std::uint32_t m = 0; m < torn.meshes.size(); ++m)
    for (std::uint32_t t = 0; t < torn.meshes[m].triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3 && !is_retired(torn.meshes[m].triangles[t]); ++k)
        place_of_point.emplace(model.point_at(m, t, k), Place{m, torn.meshes[m].triangles[t][k]});
  const auto side_of = [&](const Place& place) {
    for (const CustomAttribute& attribute : torn.meshes[place.mesh].custom_attributes)
      if (attribute.name == kTearSideAttribute) return attribute.values[place.vertex];
    return 0.0f;
  };
  for (const LipPair& pair : change.lips) {
    if (!place_of_point.contains(pair.left) || !place_of_point.contains(pair.right)) {
      faults.push_back(say("lip points ", pair.left, ", ", pair.right, " have no triangle"));
      continue;
    }
    const Place left = place_of_point.at(pair.left), right = place_of_point.at(pair.right);
    const Mesh &left_mesh = torn.meshes[left.mesh], &right_mesh = torn.meshes[right.mesh];
    if (left_mesh.positions[left.vertex] != right_mesh.positions[right.vertex])
      faults.push_back("lip points do not coincide");
    const auto left_weights = left_mesh.weights.of(left.vertex),
               right_weights = right_mesh.weights.of(right.vertex);
    const bool same =
        left_weights.size() == right_weights.size() &&
        std::all_of(left_weights.begin(), left_weights.end(), [&](const Influence& influence) {
          return std::find(right_weights.begin(), right_weights.end(), influence) !=
                 right_weights.end();
        });
    if (!same) faults.push_back("lip points have different weights");
    if (side_of(left) == side_of(right))
      faults.push_back(say("lip points ", pair.left, ", ", pair.right, " share a tear side"));
  }
  return faults;
}

}  // namespace sunder::test
