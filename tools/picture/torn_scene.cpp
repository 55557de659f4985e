#include "tools/picture/torn_scene.h"

#include <algorithm>
#include <array>

#include "tools/picture/enclosing_faces.h"
#include "tools/picture/rims.h"
#include "tools/picture/wound_flesh.h"

namespace sunder::tools {
namespace {

constexpr float kUnitOfThickness = 4;  ///< Features of flesh, in thicknesses.

/// A strip from a rim inwards: the section of the skin and the flesh below.
void add_rim(const RimEdge& edge, const DeformedMesh& posed, const Vec3f& facing, float thickness,
             RenderScene& scene) {
  std::array<Vec3f, 4> corners;
  std::array<Vec2f, 4> uvs;
  std::size_t i = 0;
  for (const std::uint32_t vertex : {edge.a, edge.b}) {
    const Vec3f& place = posed.positions[vertex];
    const float along = (place.x() + place.y() + place.z()) / (kUnitOfThickness * thickness);
    corners[i] = place;
    uvs[i++] = {along, 0.0f};
    corners[i] = place - thickness * posed.normals[vertex];
    uvs[i++] = {along, 0.3f};
  }
  for (const std::array<std::size_t, 3>& face :
       {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{1, 3, 2}}) {
    RenderTriangle triangle;
    triangle.material = ModelLooks::kFlesh;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = corners[face[k]];
      triangle.uvs[k] = uvs[face[k]];
      triangle.normals[k] = facing;
      triangle.tints[k].setOnes();
    }
    scene.triangles.push_back(triangle);
  }
}

}  // namespace

RenderScene make_torn_scene(const TornView& view, const ModelLooks& looks, double thickness) {
  RenderScene scene = looks.begin_scene();
  const auto depth = static_cast<float>(thickness);
  const std::vector<RimEdge> rims = find_rims(view.torn);
  std::vector<bool> is_torn(view.open.size(), false);
  for (const RimEdge& edge : rims) is_torn[edge.mesh] = true;
  for (std::size_t m = 0; m < is_torn.size(); ++m)  // A gap with walls has no rims.
    if (view.torn.character().meshes[m].submeshes.size() >
        view.torn.source().meshes[m].submeshes.size())
      is_torn[m] = true;
  std::vector<std::vector<bool>> inside;
  if (std::ranges::count(is_torn, true) > 0)
    inside = enclosing_faces(view.torn.character(), view.closed);
  const auto covers = view.blood.add_to(looks, scene);
  for (std::uint32_t m = 0; m < view.open.size(); ++m) {
    ModelLooks::Flesh flesh;
    flesh.first_submesh = static_cast<std::uint32_t>(view.torn.source().meshes[m].submeshes.size());
    flesh.unit = kUnitOfThickness * depth;
    if (is_torn[m]) flesh.inside = &inside[m];
    if (m < covers.size()) flesh.covers = covers[m];
    flesh.reaches = view.blood.reaches_of(m);
    looks.add_mesh(view.torn.character().meshes[m], view.open[m], flesh, scene);
  }
  const WoundFlesh wounds(view.torn, view.wounds, view.closed);
  wounds.add(view.closed, view.open, ModelLooks::kFlesh, scene);
  for (const RimEdge& edge : rims) {
    if (wounds.has_lip(edge)) continue;
    const DeformedMesh& posed = view.open[edge.mesh];
    const Vec3f along = posed.positions[edge.b] - posed.positions[edge.a];
    const Vec3f facing = along.cross(posed.normals[edge.a]);
    if (facing.norm() > 0) add_rim(edge, posed, facing.normalized(), depth, scene);
  }
  return scene;
}

}  // namespace sunder::tools
