#include "validation/checks/attribute_checks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/internal/ordered.h"
#include "validation/checks/inherited.h"
#include "validation/match/position_table.h"

namespace sunder::validation {
namespace {

/// The morph target of the source that corresponds to one of the target: by name, else by number.
const MorphTarget* counterpart(const Mesh& source, const Mesh& target, std::size_t index) {
  const MorphTarget& of = target.morph_targets[index];
  for (const MorphTarget& morph : source.morph_targets)
    if (!of.name.empty() && morph.name == of.name) return &morph;
  return index < source.morph_targets.size() ? &source.morph_targets[index] : nullptr;
}

Vec3d interpolated(const std::vector<Vec3f>& values, const Triangle& triangle,
                   const std::array<double, 3>& barycentric) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) sum += barycentric[k] * values[triangle[k]].cast<double>();
  return sum;
}

/// How far morph targets move the matched place although they leave this vertex alone; metres.
double lost_morph(const RowReader& reader, Index mesh, Index vertex) {
  const SurfaceMatch& match = reader.match(mesh, vertex);
  const Mesh &target = reader.target().character.meshes[mesh],
             &source = reader.source().character.meshes[match.mesh];
  double lost = 0.0;
  for (std::size_t i = 0; i < target.morph_targets.size(); ++i) {
    const MorphTarget* const morph = counterpart(source, target, i);
    if (morph == nullptr || morph->position_deltas.empty()) continue;
    const double expected = norm(
        interpolated(morph->position_deltas, source.triangles[match.triangle], match.barycentric));
    const auto& deltas = target.morph_targets[i].position_deltas;
    const double actual = deltas.empty() ? 0.0 : norm(deltas[vertex].cast<double>());
    if (actual <= 1e-3 * expected) lost = std::max(lost, expected);
  }
  return lost;
}

void check_morphs(const RowReader& reader, FindingList& findings) {
  const Skinned& target = reader.target();
  const double least = kind_of(Code::morph_lost).threshold * reader.source().surface.diagonal;
  Places places;
  bool has_morphs = false;
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh) {
    has_morphs |= !target.character.meshes[mesh].morph_targets.empty();
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      if (!reader.match(mesh, v).is_accepted) continue;
      const double lost = lost_morph(reader, mesh, v);
      if (lost > least) places.push_back(target.place(mesh, v, kNone, lost));
    }
  }
  if (!has_morphs) return findings.not_tested(Code::morph_lost, "no morph targets");
  findings.add(Code::morph_lost, std::move(places));
}

/// An attribute of a vertex, compared with that of the vertices of the source at the same place.
struct Attribute {
  Code code;
  /// The difference between two vertices; nothing if either mesh lacks the attribute.
  std::optional<double> (*difference)(const Mesh&, Index, const Mesh&, Index);
  /// Whether the target's mesh lost it.
  bool (*is_missing)(const Mesh& source, const Mesh& target);
};

double angle_between(const Vec3f& a, const Vec3f& b) {
  const Vec3d u = a.cast<double>(), v = b.cast<double>();
  return std::atan2(norm(u.cross(v)), dot(u, v));
}

std::optional<double> normal_difference(const Mesh& a, Index i, const Mesh& b, Index j) {
  if (a.normals.empty() || b.normals.empty()) return {};
  return angle_between(a.normals[i], b.normals[j]);
}

std::optional<double> tangent_difference(const Mesh& a, Index i, const Mesh& b, Index j) {
  if (a.tangents.empty() || b.tangents.empty()) return {};
  return angle_between(a.tangents[i].head<3>(), b.tangents[j].head<3>());
}

std::optional<double> uv_difference(const Mesh& a, Index i, const Mesh& b, Index j) {
  if (a.uv_sets.empty() || b.uv_sets.empty()) return {};
  return static_cast<double>((a.uv_sets[0][i] - b.uv_sets[0][j]).cwiseAbs().maxCoeff());
}

/// Only vertices that stand where vertices of the source stand are compared: between them, seams
/// and hard edges have several right answers.
Places different_vertices(const RowReader& reader, const PositionTable& table,
                          const Attribute& attribute) {
  const Skinned &source = reader.source(), &target = reader.target();
  Places places;
  for (Index v = 0; v < target.surface.vertex_count(); ++v) {
    const Index mesh = target.surface.mesh_of_vertex(v),
                own = v - target.surface.first_vertex[mesh];
    std::optional<double> least;
    table.find(target.surface.positions[v], [&](Index other) {
      const Index of = source.surface.mesh_of_vertex(other);
      const auto difference =
          attribute.difference(target.character.meshes[mesh], own, source.character.meshes[of],
                               other - source.surface.first_vertex[of]);
      if (difference && (!least || *difference < *least)) least = difference;
      return false;
    });
    if (least && *least > kind_of(attribute.code).threshold)
      places.push_back(target.place(mesh, own, kNone, *least));
  }
  return places;
}

/// Meshes that lack the attribute although the source's mesh that they lie on has it.
Places incomplete_meshes(const RowReader& reader, const Attribute& attribute) {
  Places places;
  const auto& meshes = reader.target().character.meshes;
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index v = 0; v < meshes[mesh].vertex_count(); ++v) {
      const SurfaceMatch& match = reader.match(mesh, v);
      if (!match.is_accepted) continue;
      FindingPlace place;
      place.mesh = mesh;
      place.value = kind_of(attribute.code).threshold;
      if (attribute.is_missing(reader.source().character.meshes[match.mesh], meshes[mesh]))
        places.push_back(place);
      break;
    }
  return places;
}

constexpr std::array kAttributes = {
    Attribute{Code::normals, normal_difference,
              [](const Mesh& a, const Mesh& b) { return !a.normals.empty() && b.normals.empty(); }},
    Attribute{
        Code::tangents, tangent_difference,
        [](const Mesh& a, const Mesh& b) { return !a.tangents.empty() && b.tangents.empty(); }},
    Attribute{Code::uv, uv_difference,
              [](const Mesh& a, const Mesh& b) { return a.uv_sets.size() > b.uv_sets.size(); }},
};

/// Faces without area, as their first vertices; too many faces at an edge; unused vertices.
Places unhealthy_places(const Skinned& skin) {
  Places places;
  for (Index t = 0; t < skin.surface.triangles.size(); ++t) {
    const Triangle& face = skin.surface.triangles[t];
    if (!skin.surface.has_area[t] && !is_retired(face))
      places.push_back(skin.place(face[0], kNone, 1.0));
  }
  for (const auto& edge : skin.graph.edges)
    if (edge.faces > 2)
      places.push_back(skin.place(skin.graph.vertex_of_point[edge.a], kNone, edge.faces));
  return places;
}

}  // namespace

void check_attributes(const RowReader& reader, FindingList& findings) {
  check_morphs(reader, findings);
  const BindSurface& source = reader.source().surface;
  PositionTable table(source.positions.size());
  for (Index v = 0; v < source.vertex_count(); ++v) table.insert(source.positions[v], v);
  for (const Attribute& attribute : kAttributes) {
    Places places = different_vertices(reader, table, attribute);
    const Places incomplete = incomplete_meshes(reader, attribute);
    places.insert(places.end(), incomplete.begin(), incomplete.end());
    findings.add(attribute.code, std::move(places));
  }
}

void check_mesh_health(const RowReader& reader, FindingList& findings) {
  add_not_inherited(reader, Code::mesh_health, unhealthy_places, findings);
}

}  // namespace sunder::validation
