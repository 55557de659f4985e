#include "pipeline/validation/checks/attribute_checks.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "pipeline/validation/checks/face_attributes.h"
#include "pipeline/validation/checks/inherited.h"

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

/// A displacement that differs from that of the surface by more than this share of the largest one
/// around is wrong. Half, because poses, quantisation and other places on the face explain less.
constexpr double kWrongMorph = 0.5;

/// The largest difference between how a morph target moves the matched place and this vertex, as
/// far as that is wrong; bind space.
double wrong_morph(const RowReader& reader, Index mesh, Index vertex) {
  const SurfaceMatch& match = reader.match(mesh, vertex);
  const Mesh &target = reader.target().character.meshes[mesh],
             &source = reader.source().character.meshes[match.mesh];
  const bool is_on_surface = match.distance <= 1e-6 * reader.source().surface.diagonal;
  const Triangle& corners = source.triangles[match.triangle];
  double worst = 0.0;
  for (std::size_t i = 0; i < target.morph_targets.size(); ++i) {
    const MorphTarget* const morph = counterpart(source, target, i);
    if (morph == nullptr || morph->position_deltas.empty()) continue;
    const Vec3d expected = interpolated(morph->position_deltas, corners, match.barycentric);
    const auto& deltas = target.morph_targets[i].position_deltas;
    const Vec3d actual =
        deltas.empty() ? Vec3d(Vec3d::Zero()) : Vec3d(deltas[vertex].cast<double>());
    const double difference = norm(actual - expected);
    if (norm(actual) <= 1e-3 * norm(expected)) worst = std::max(worst, difference);
    if (!is_on_surface || difference <= worst) continue;
    double largest = 0.0;
    for (const Index corner : corners)
      largest = std::max(largest, norm(morph->position_deltas[corner].cast<double>()));
    if (difference > kWrongMorph * largest) worst = difference;
  }
  return worst;
}

void check_morphs(const RowReader& reader, FindingList& findings) {
  const Skinned& target = reader.target();
  const double unit = reader.source().metres_per_bind_unit;
  const double least =
      kind_of(Code::morph_lost).threshold * unit * reader.source().surface.diagonal;
  Places places;
  bool has_morphs = false;
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh) {
    has_morphs |= !target.character.meshes[mesh].morph_targets.empty();
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      if (!reader.match(mesh, v).is_accepted) continue;
      const double wrong = unit * wrong_morph(reader, mesh, v);
      if (wrong > least) places.push_back(target.place(mesh, v, kNone, wrong));
    }
  }
  if (!has_morphs) return findings.not_tested(Code::morph_lost, "no morph targets");
  findings.add(Code::morph_lost, std::move(places));
}

/// An attribute of vertices and the code of its faults.
struct Attribute {
  Code code;
  FaceAttribute attribute;
  /// Whether the target's mesh lost it.
  bool (*is_missing)(const Mesh& source, const Mesh& target);
};

Places different_vertices(const RowReader& reader, const Attribute& of,
                          FaceAttributes& attributes) {
  const Skinned& target = reader.target();
  const double threshold = kind_of(of.code).threshold;
  Places places;
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh)
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      const double difference = attributes.difference(of.attribute, mesh, v, threshold);
      if (difference > threshold) places.push_back(target.place(mesh, v, kNone, difference));
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
    Attribute{Code::normals, FaceAttribute::normals,
              [](const Mesh& a, const Mesh& b) { return !a.normals.empty() && b.normals.empty(); }},
    Attribute{
        Code::tangents, FaceAttribute::tangents,
        [](const Mesh& a, const Mesh& b) { return !a.tangents.empty() && b.tangents.empty(); }},
    Attribute{Code::uv, FaceAttribute::uv,
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
  FaceAttributes attributes(reader);
  for (const Attribute& attribute : kAttributes) {
    Places places = different_vertices(reader, attribute, attributes);
    const Places incomplete = incomplete_meshes(reader, attribute);
    places.insert(places.end(), incomplete.begin(), incomplete.end());
    findings.add(attribute.code, std::move(places));
  }
}

void check_mesh_health(const RowReader& reader, FindingList& findings) {
  add_not_inherited(reader, Code::mesh_health, unhealthy_places, findings);
}

}  // namespace sunder::validation
