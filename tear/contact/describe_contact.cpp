#include "tear/contact/describe_contact.h"

#include <cmath>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"
#include "skinning/internal/reference.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

Vec3d unit_normal(const Corners& corners) {
  return normalized(Vec3d(corners[1] - corners[0]).cross(Vec3d(corners[2] - corners[0])));
}

/// The weight of a slot at a place of a triangle.
double weight_at(Index slot, const Mesh& mesh, const Triangle& triangle,
                 const std::array<double, 3>& barycentric) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (const Influence& influence : mesh.weights.of(triangle[k]))
      if (influence.slot == slot) sum += barycentric[k] * static_cast<double>(influence.weight);
  return sum;
}

/// The bone with the greatest weight; of equal ones the first in the skeleton.
Index dominant_bone(const Mesh& mesh, const Skin& skin, const Triangle& triangle,
                    const std::array<double, 3>& barycentric) {
  double greatest = -1;
  Index found = 0;
  for (const Index vertex : triangle)
    for (const Influence& influence : mesh.weights.of(vertex)) {
      const double weight = weight_at(influence.slot, mesh, triangle, barycentric);
      const Index bone = skin.bones[influence.slot];
      if (weight < greatest || (weight == greatest && bone >= found)) continue;
      greatest = weight;
      found = bone;
    }
  return found;
}

Vec3d interpolated_normal(Index mesh_index, const Triangle& triangle,
                          const std::array<double, 3>& barycentric, const PosedSurface& surface) {
  const Mesh& mesh = surface.editor().character().meshes[mesh_index];
  Vec3d sum = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    sum += barycentric[k] * deform_normal_reference(mesh, triangle[k],
                                                    surface.pose().palette(mesh.skin),
                                                    surface.pose().morph_weights());
  return normalized(sum);
}

/// The normal of a face times its angle at a corner.
Vec3d weighted_normal(Index corner, PosedSurface& surface) {
  const Corners corners = surface.corners(corner / 3);
  const Index k = corner % 3;
  const Vec3d to_next = corners[(k + 1) % 3] - corners[k],
              to_previous = corners[(k + 2) % 3] - corners[k];
  const Vec3d across = to_next.cross(to_previous);
  return elementary::atan2(norm(across), dot(to_next, to_previous)) * normalized(across);
}

}  // namespace

SurfaceContact describe_place(Index face, const std::array<double, 3>& barycentric,
                              bool interpolates_normals, PosedSurface& surface) {
  const SurfaceEditor& editor = surface.editor();
  const TriangleRef ref = editor.surface().triangle(face);
  const Mesh& mesh = editor.character().meshes[ref.mesh];
  const Triangle& triangle = mesh.triangles[ref.triangle];
  const Corners corners = surface.corners(face);

  SurfaceContact contact;
  contact.barycentric = barycentric;
  for (std::size_t k = 0; k < 3; ++k) contact.place += barycentric[k] * corners[k];
  contact.normal = unit_normal(corners);
  contact.interpolated_normal = interpolates_normals && !mesh.normals.empty()
                                    ? interpolated_normal(ref.mesh, triangle, barycentric, surface)
                                    : contact.normal;
  contact.mesh = ref.mesh;
  contact.triangle = ref.triangle;
  contact.submesh = mesh.triangle_submesh[ref.triangle];
  contact.material = mesh.submeshes[contact.submesh].material;
  contact.bone = dominant_bone(mesh, editor.character().skins[mesh.skin], triangle, barycentric);
  contact.anchor = {ref.mesh, {ref.source_triangle, {0, 0, 0}}};
  for (Index k = 0; k < 3; ++k) {
    const std::array<double, 3> at = editor.source_barycentric(3 * face + k);
    for (std::size_t i = 0; i < 3; ++i)
      contact.anchor.birth.barycentric[i] += barycentric[k] * at[i];
  }
  return contact;
}

Vec3d outward_at(const FoundPlace& place, PosedSurface& surface) {
  const Surface& topology = surface.editor().surface();
  std::array<Index, 3> inside;  // corners whose coordinate is not 0
  std::size_t count = 0;
  for (Index k = 0; k < 3; ++k)
    if (place.barycentric[k] > 0) inside[count++] = k;
  Vec3d sum = Vec3d::Zero();
  if (count == 1) {
    topology.for_each_in_fan(3 * place.face + inside[0],
                             [&](Index corner) { sum += weighted_normal(corner, surface); });
    return sum;
  }
  sum = unit_normal(surface.corners(place.face));
  if (count == 3) return sum;
  // The edge leaves the corner after which the coordinate that is 0 comes second.
  const Index edge = 3 * place.face + (inside[0] == 0 && inside[1] == 2 ? 2 : inside[0]);
  if (topology.twin[edge] != kNone) sum += unit_normal(surface.corners(topology.twin[edge] / 3));
  return sum;
}

}  // namespace sunder::tear
