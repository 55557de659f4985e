#include "io/assimp/normals.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>
#include <unordered_map>

#include <Eigen/Geometry>

namespace sunder::assimp_import {
namespace {

/// Position and weights of a vertex as bytes.
std::string point_key(const MeshPart& part, std::uint32_t vertex) {
  const float* position = part.streams[0].values.data() + std::size_t{vertex} * 3;
  std::string key(reinterpret_cast<const char*>(position), 3 * sizeof(float));
  if (part.weights.vertex_count() != 0) {
    const auto influences = part.weights.of(vertex);
    key.append(reinterpret_cast<const char*>(influences.data()), influences.size_bytes());
  }
  return key;
}

}  // namespace

void generate_missing_normals(std::span<MeshPart> parts, Notes& notes) {
  if (std::all_of(parts.begin(), parts.end(),
                  [](const MeshPart& part) { return part.vertices_without_normal.empty(); }))
    return;

  std::unordered_map<std::string, Vec3d> normal_of_point;
  for (const MeshPart& part : parts) {
    for (const Triangle& triangle : part.triangles) {
      const Vec3d a = part.position(triangle[0]);
      const Vec3d twice_area =
          (part.position(triangle[1]) - a).cross(part.position(triangle[2]) - a);
      for (const std::uint32_t vertex : triangle)
        normal_of_point.try_emplace(point_key(part, vertex), Vec3d::Zero()).first->second +=
            twice_area;
    }
  }

  for (MeshPart& part : parts) {
    if (part.vertices_without_normal.empty()) continue;
    std::uint32_t undefined = 0;
    std::vector<float>& normals = part.find("NORMAL")->values;
    for (const std::uint32_t vertex : part.vertices_without_normal) {
      const auto found = normal_of_point.find(point_key(part, vertex));
      Vec3d normal = found == normal_of_point.end() ? Vec3d(Vec3d::Zero()) : found->second;
      const double length = normal.stableNorm();
      if (length > 1e-300) {
        normal /= length;
      } else {
        // The vertex has no triangle of non-zero area, so any direction is valid.
        normal = Vec3d::UnitY();
        ++undefined;
      }
      for (int i = 0; i < 3; ++i)
        normals[std::size_t{vertex} * 3 + static_cast<std::size_t>(i)] =
            static_cast<float>(normal[i]);
    }
    const auto missing = static_cast<std::uint32_t>(part.vertices_without_normal.size());
    if (missing == part.vertex_count())
      notes.inform(part.place, "the file has no normals; smooth ones generated", missing);
    else
      notes.repaired(StatusCode::malformed_file, part.place,
                     "normals without direction; smooth ones generated", missing);
    notes.inform(part.place, "vertices without a triangle of non-zero area; normal set to +y",
                 undefined);
    part.vertices_without_normal.clear();
  }
}

}  // namespace sunder::assimp_import
