#include "pipeline/validation/match/weld.h"

#include "pipeline/validation/match/position_table.h"

namespace sunder::validation {

std::span<const float> tear_sides(const Mesh& mesh) {
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    if (attribute.name == kTearSideAttribute && attribute.components == 1) return attribute.values;
  return {};
}

Weld weld_vertices(const Character& character, std::span<const Vec3d> positions) {
  struct FirstVertex {
    float side;
    Index skin;
  };
  std::vector<FirstVertex> of_point;
  PositionTable table(positions.size());
  Weld weld;
  weld.point_of_vertex.reserve(positions.size());
  for (const Mesh& mesh : character.meshes) {
    const std::span<const float> sides = tear_sides(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3d& position = positions[weld.point_of_vertex.size()];
      const float side = sides.empty() ? 0.0f : sides[v];
      Index point = kNone;
      table.find(position, [&](Index candidate) {
        const FirstVertex& first = of_point[candidate];
        if (first.side == side && first.skin == mesh.skin) point = candidate;
        return point != kNone;
      });
      if (point == kNone) {
        point = weld.point_count++;
        of_point.push_back({side, mesh.skin});
        table.insert(position, point);
      }
      weld.point_of_vertex.push_back(point);
    }
  }
  return weld;
}

}  // namespace sunder::validation
