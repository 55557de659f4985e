#include "support/torn_invariants.h"

#include <sunder/skinning/palette.h>
#include <sunder/skinning/reference.h>
#include <sunder/tear/topology.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "support/rigs.h"

namespace sunder::test {
namespace {

template <class... Parts>
std::string say(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

template <class T>
bool starts_with(const std::vector<T>& grown, const std::vector<T>& source) {
  return grown.size() >= source.size() &&
         (source.empty() || std::memcmp(grown.data(), source.data(), source.size() * sizeof(T)) == 0);
}

bool keeps_source_vertices(const Mesh& torn, const Mesh& source) {
  bool same = starts_with(torn.positions, source.positions) && starts_with(torn.normals, source.normals) &&
              starts_with(torn.tangents, source.tangents) && starts_with(torn.weights.first, source.weights.first) &&
              starts_with(torn.weights.influences, source.weights.influences) && torn.uv_sets.size() == source.uv_sets.size() &&
              torn.color_sets.size() == source.color_sets.size() && torn.morph_targets.size() == source.morph_targets.size();
  for (std::size_t i = 0; same && i < source.uv_sets.size(); ++i) same = starts_with(torn.uv_sets[i], source.uv_sets[i]);
  for (std::size_t i = 0; same && i < source.color_sets.size(); ++i) same = starts_with(torn.color_sets[i], source.color_sets[i]);
  for (std::size_t i = 0; same && i < source.morph_targets.size(); ++i)
    same = starts_with(torn.morph_targets[i].position_deltas, source.morph_targets[i].position_deltas) &&
           starts_with(torn.morph_targets[i].normal_deltas, source.morph_targets[i].normal_deltas) &&
           starts_with(torn.morph_targets[i].tangent_deltas, source.morph_targets[i].tangent_deltas);
  for (std::size_t i = 0; same && i < source.custom_attributes.size(); ++i)
    same = source.custom_attributes[i].name == kTearSideAttribute ||
           starts_with(torn.custom_attributes[i].values, source.custom_attributes[i].values);
  return same;
}

/// Where each corner of a torn triangle lies in its source triangle, or nothing where a vertex does not belong to it.
std::optional<std::array<double, 3>> place_in_source(const TornModel& model, std::uint32_t mesh, std::uint32_t triangle,
                                                     std::uint32_t corner) {
  const Mesh& source = model.source().meshes[mesh];
  const Triangle in = source.triangles[model.source_triangle(mesh, triangle)];
  const std::uint32_t vertex = model.character().meshes[mesh].triangles[triangle][corner];
  std::array<double, 3> place = {0, 0, 0};
  const auto add = [&](std::uint32_t parent, double part) {
    const auto at = std::find(in.begin(), in.end(), parent);
    if (at == in.end()) return false;
    place[static_cast<std::size_t>(at - in.begin())] += part;
    return true;
  };
  if (vertex < source.vertex_count()) {
    if (!add(vertex, 1.0)) return std::nullopt;
    return place;
  }
  const Birth birth = model.birth(mesh, vertex);
  for (std::size_t k = 0; k < 3; ++k)
    if (birth.barycentric[k] > 0 && !add(source.triangles[birth.triangle][k], birth.barycentric[k])) return std::nullopt;
  return place;
}

void check_cover(const TornModel& model, std::uint32_t m, std::vector<std::string>& faults) {
  const Mesh& torn = model.character().meshes[m];
  const Mesh& source = model.source().meshes[m];
  std::vector<double> covered(source.triangle_count(), 0.0);
  for (std::uint32_t t = 0; t < torn.triangle_count(); ++t) {
    const std::uint32_t of = model.source_triangle(m, t);
    if (t < source.triangle_count() && of != t) faults.push_back(say("mesh ", m, ": triangle ", t, " changed its source"));
    if (torn.triangle_submesh[t] != source.triangle_submesh[of])
      faults.push_back(say("mesh ", m, ": triangle ", t, " changed its submesh"));
    if (torn.triangles[t] == source.triangles[of]) {
      covered[of] += 1;
      continue;
    }
    std::array<std::array<double, 3>, 3> place;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto found = place_in_source(model, m, t, k);
      if (!found) {
        faults.push_back(say("mesh ", m, ": triangle ", t, " has a vertex from outside its source triangle"));
        return;
      }
      place[k] = *found;
    }
    const double area = place[0][0] * (place[1][1] * place[2][2] - place[1][2] * place[2][1]) -
                        place[0][1] * (place[1][0] * place[2][2] - place[1][2] * place[2][0]) +
                        place[0][2] * (place[1][0] * place[2][1] - place[1][1] * place[2][0]);
    if (!(area > 0)) faults.push_back(say("mesh ", m, ": triangle ", t, " covers ", area, " of its source triangle"));
    covered[of] += area;

    const auto cross = [](const Mesh& mesh, const Triangle& triangle) -> Eigen::Vector3d {
      const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
      return (mesh.positions[triangle[1]].cast<double>() - a).cross(mesh.positions[triangle[2]].cast<double>() - a);
    };
    if (!cross(source, source.triangles[of]).isZero(0) &&
        !(cross(torn, torn.triangles[t]).dot(cross(source, source.triangles[of])) > 0))
      faults.push_back(say("mesh ", m, ": triangle ", t, " has no area, or turned over, in bind space"));
  }
  for (std::uint32_t t = 0; t < source.triangle_count(); ++t)
    if (std::abs(covered[t] - 1) > 1e-9)
      faults.push_back(say("mesh ", m, ": parts of triangle ", t, " cover ", covered[t], " of it"));
}

Character with_lips_closed(const Character& torn) {
  Character closed = torn;
  for (Mesh& mesh : closed.meshes)
    for (CustomAttribute& attribute : mesh.custom_attributes)
      if (attribute.name == kTearSideAttribute) std::fill(attribute.values.begin(), attribute.values.end(), 0.0f);
  return closed;
}

}  // namespace

std::vector<std::string> broken_laws(const TornModel& model) {
  std::vector<std::string> faults;
  const Character &torn = model.character(), &source = model.source();
  if (Status status = validate_character(torn); !status) faults.push_back(say("not valid: ", status.text()));
  for (std::uint32_t m = 0; m < torn.meshes.size(); ++m) {
    if (!keeps_source_vertices(torn.meshes[m], source.meshes[m])) faults.push_back(say("mesh ", m, ": a source vertex changed"));
    check_cover(model, m, faults);
  }
  return faults;
}

std::vector<std::string> broken_surface(const TornModel& model) {
  std::vector<std::string> faults;
  const TopologyCounts before = count_topology(model.source()), after = count_topology(model.character());
  if (after.non_manifold_edges > before.non_manifold_edges)
    faults.push_back(say("non-manifold edges: ", before.non_manifold_edges, " -> ", after.non_manifold_edges));
  // The surface that the arrays describe is the one that the kernel kept. Where a source edge has many faces, splitting some of
  // them leaves others that join when looked at afresh.
  if (before.non_manifold_edges == 0 && after.points != model.point_count())
    faults.push_back(say("arrays describe ", after.points, " points, the kernel has ", model.point_count()));
  return faults;
}

bool is_clear_of_itself(const Character& source) {
  std::set<std::array<float, 3>> places;
  for (const Mesh& mesh : source.meshes)
    for (const Vec3f& position : mesh.positions) places.insert({position.x() + 0.0f, position.y() + 0.0f, position.z() + 0.0f});
  const TopologyCounts counts = count_topology(source);
  return counts.non_manifold_edges == 0 && counts.points == places.size();
}

std::vector<std::string> broken_closure(const TornModel& model) {
  std::vector<std::string> faults;
  const TopologyCounts before = count_topology(model.source()), closed = count_topology(with_lips_closed(model.character()));
  if (closed.components != before.components || closed.boundary_loops != before.boundary_loops ||
      closed.non_manifold_edges != before.non_manifold_edges)
    faults.push_back(say("with lips closed: components ", before.components, " -> ", closed.components, ", boundary loops ",
                         before.boundary_loops, " -> ", closed.boundary_loops, ", non-manifold edges ", before.non_manifold_edges,
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
      for (std::uint32_t k = 0; k < 3; ++k)
        place_of_point.emplace(model.point_at(m, t, k), Place{m, torn.meshes[m].triangles[t][k]});
  const auto side_of = [&](const Place& place) {
    for (const CustomAttribute& attribute : torn.meshes[place.mesh].custom_attributes)
      if (attribute.name == kTearSideAttribute) return attribute.values[place.vertex];
    return 0.0f;
  };
  for (const LipPair& pair : change.lips) {
    const Place left = place_of_point.at(pair.left), right = place_of_point.at(pair.right);
    const Mesh &left_mesh = torn.meshes[left.mesh], &right_mesh = torn.meshes[right.mesh];
    if (left_mesh.positions[left.vertex] != right_mesh.positions[right.vertex]) faults.push_back("lip points do not coincide");
    const auto left_weights = left_mesh.weights.of(left.vertex), right_weights = right_mesh.weights.of(right.vertex);
    const bool same = left_weights.size() == right_weights.size() &&
                      std::all_of(left_weights.begin(), left_weights.end(), [&](const Influence& influence) {
                        return std::find(right_weights.begin(), right_weights.end(), influence) != right_weights.end();
                      });
    if (!same) faults.push_back("lip points have different weights");
    if (side_of(left) == side_of(right)) faults.push_back(say("lip points ", pair.left, ", ", pair.right, " share a tear side"));
  }
  return faults;
}

std::vector<std::string> broken_closed_form(const TornModel& model, const ModelPose& pose) {
  std::vector<std::string> faults;
  const double diagonal = posed_diagonal(model.source(), pose);
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& torn = model.character().meshes[m];
    const Mesh& source = model.source().meshes[m];
    if (torn.triangles == source.triangles) continue;
    const Skin& skin = model.source().skins[source.skin];
    std::vector<Affine3d> palette(skin.bones.size());
    if (!compute_palette(skin, pose, palette)) return {"no palette"};
    const auto position = [&](const Mesh& mesh, std::uint32_t v) {
      return deform_position_reference(mesh, v, palette, pose.morph_weights);
    };
    const auto morphed = [&](std::uint32_t v) {
      Vec3d p = source.positions[v].cast<double>();
      for (std::size_t j = 0; j < source.morph_targets.size(); ++j)
        if (!source.morph_targets[j].position_deltas.empty())
          p += static_cast<double>(pose.morph_weights[source.first_morph_weight + j]) *
               source.morph_targets[j].position_deltas[v].cast<double>();
      return p;
    };
    // Rounding of the stored floats, seen through the largest matrix: positions and weights carry 2^-24 each.
    double largest = 0;
    for (const Affine3d& matrix : palette) largest = std::max(largest, matrix.linear().norm());
    for (std::uint32_t v = source.vertex_count(); v < torn.vertex_count(); ++v) {
      const Birth birth = model.birth(m, v);
      const Triangle parents = source.triangles[birth.triangle];
      Vec3d expected = Vec3d::Zero();
      double reach = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        expected += birth.barycentric[k] * position(source, parents[k]);
        reach = std::max(reach, morphed(parents[k]).norm());
        for (const Influence& influence : source.weights.of(parents[k]))
          reach = std::max(reach, (palette[influence.slot] * morphed(parents[k])).norm() / std::max(largest, 1e-30));
      }
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = k + 1; l < 3; ++l) {
          const Vec3d edge = morphed(parents[k]) - morphed(parents[l]);
          const double product = birth.barycentric[k] * birth.barycentric[l];
          for (const Influence& influence : source.weights.of(parents[k]))
            expected -= product * static_cast<double>(influence.weight) * (palette[influence.slot].linear() * edge);
          for (const Influence& influence : source.weights.of(parents[l]))
            expected += product * static_cast<double>(influence.weight) * (palette[influence.slot].linear() * edge);
        }
      const double error = (position(torn, v) - expected).norm();
      const double rounding = 2e-6 * std::max(diagonal, largest * reach);
      if (!(error <= rounding))
        faults.push_back(say("mesh ", m, " vertex ", v, ": ", error, " from the closed form, rounding explains ", rounding));
    }
  }
  return faults;
}

}  // namespace sunder::test
