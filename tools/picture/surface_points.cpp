#include "tools/picture/surface_points.h"

namespace sunder::tools {

std::vector<Vec3f> places_of_points(const CharacterInstance& instance,
                                    const std::vector<DeformedMesh>& posed) {
  std::vector<Vec3f> places(instance.particles()->point_count(), Vec3f::Zero());
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const std::span<const std::uint32_t> points = instance.particles()->vertex_points(m);
    for (std::uint32_t v = 0; v < points.size(); ++v)
      if (points[v] < places.size()) places[points[v]] = posed[m].positions[v];
  }
  return places;
}

SurfacePoints::SurfacePoints(const CharacterInstance& instance,
                             const std::vector<DeformedMesh>& posed)
    : places_(places_of_points(instance, posed)), is_lip_(places_.size(), false) {
  for (const LipEdge& edge : instance.particles()->lips())
    for (const std::uint32_t point : edge.points)
      if (point < is_lip_.size()) is_lip_[point] = true;
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const std::span<const std::uint32_t> points = instance.particles()->vertex_points(m);
    for (const Triangle& triangle : instance.character().meshes[m].triangles) {
      if (is_retired(triangle)) continue;
      const Triangle corners = {points[triangle[0]], points[triangle[1]], points[triangle[2]]};
      const auto is_known = [this](std::uint32_t point) { return point < places_.size(); };
      if (std::all_of(corners.begin(), corners.end(), is_known)) triangles_.push_back(corners);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t a = corners[c], b = corners[(c + 1) % 3];
        if (!is_known(a) || !is_known(b)) continue;
        edges_.push_back({a, b});
        edges_.push_back({b, a});
      }
    }
  }
  std::sort(edges_.begin(), edges_.end());
}

}  // namespace sunder::tools
