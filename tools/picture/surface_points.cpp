#include "tools/picture/surface_points.h"

namespace sunder::tools {

SurfacePoints::SurfacePoints(const CharacterInstance& instance,
                             const std::vector<DeformedMesh>& posed)
    : places_(instance.particles()->point_count(), Vec3f::Zero()) {
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const std::span<const std::uint32_t> points = instance.particles()->vertex_points(m);
    for (std::uint32_t v = 0; v < points.size(); ++v)
      if (points[v] < places_.size()) places_[points[v]] = posed[m].positions[v];
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
