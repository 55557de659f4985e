#include "support/oracles/face_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::test {

FaceQuality face_quality(const TornModel& model) {
  FaceQuality quality;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      const Triangle& triangle = mesh.triangles[t];
      if (is_retired(triangle) ||
          model.source_triangle(m, t) >= model.source().meshes[m].triangle_count())
        continue;
      double smallest = std::numbers::pi;
      bool has_area = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d at = mesh.positions[triangle[k]].cast<double>();
        const Eigen::Vector3d one = mesh.positions[triangle[(k + 1) % 3]].cast<double>() - at;
        const Eigen::Vector3d other = mesh.positions[triangle[(k + 2) % 3]].cast<double>() - at;
        const double area = one.cross(other).norm();
        has_area = has_area && area > 0;
        smallest = std::min(smallest, std::atan2(area, one.dot(other)));
      }
      if (!has_area) ++quality.faces_without_area;
      quality.smallest_angles.push_back(has_area ? smallest * 180 / std::numbers::pi : 0.0);
    }
  }
  std::sort(quality.smallest_angles.begin(), quality.smallest_angles.end());
  return quality;
}

double FaceQuality::angle_at(double part) const {
  return smallest_angles[static_cast<std::size_t>(part *
                                                  static_cast<double>(smallest_angles.size() - 1))];
}

}  // namespace sunder::test
