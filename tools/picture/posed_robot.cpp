#include "tools/picture/posed_robot.h"

#include <cstddef>

namespace sunder::tools {
namespace {

const Vec4f kSteel(0.42f, 0.47f, 0.55f, 1.0f);

}  // namespace

Result<std::vector<Mesh>> robot_surfaces(const PosedRobot& robot) {
  if (robot.character.meshes.empty()) return std::vector<Mesh>();
  const Result<std::vector<DeformedMesh>> posed = pose_model(robot.character, robot.pose);
  if (!posed) return posed.error();
  std::vector<Mesh> surfaces = robot.character.meshes;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    Mesh& surface = surfaces[i];
    surface.positions = (*posed)[i].positions;
    surface.normals = (*posed)[i].normals;
    surface.color_sets.assign(1, std::vector<Vec4f>(surface.positions.size(), kSteel));
    for (Submesh& submesh : surface.submeshes) submesh.material = kNone;
  }
  return surfaces;
}

void add_surfaces(const std::vector<Mesh>& surfaces, const ModelLooks& looks, RenderScene& scene) {
  for (const Mesh& surface : surfaces)
    looks.add_mesh(surface, {surface.positions, surface.normals, {}}, {}, scene);
}

std::vector<Vec3d> places_near(const std::vector<Mesh>& surfaces, const Vec3d& place,
                               double distance) {
  std::vector<Vec3d> near;
  for (const Mesh& surface : surfaces)
    for (const Vec3f& position : surface.positions)
      if ((position.cast<double>() - place).norm() <= distance)
        near.emplace_back(position.cast<double>());
  return near;
}

}  // namespace sunder::tools
