#include "tear/surface/cracks.h"

#include <algorithm>
#include <tuple>

namespace sunder::tear {
namespace {

/// An end of an edge: its place in bind space and its side of an older tear, whose lips are no
/// crack.
using End = std::tuple<float, float, float, Index>;

struct Border {
  Index skin;
  std::array<End, 2> ends;  ///< Ascending.
  Index half_edge;
  bool is_reversed;

  [[nodiscard]] bool is_beside(const Border& other) const {
    return skin == other.skin && ends == other.ends;
  }
};

std::vector<Border> borders_of(const Character& character, const Surface& surface) {
  std::vector<Border> borders;
  for (Index h = 0; h < surface.twin.size(); ++h) {
    if (surface.twin[h] != kNone || surface.has_repeated_point(h / 3)) continue;
    const TriangleRef ref = surface.triangle(h / 3);
    const Mesh& mesh = character.meshes[ref.mesh];
    const auto end_at = [&](Index corner) {
      const Vec3f& at = mesh.positions[mesh.triangles[ref.triangle][corner % 3]];
      return End{at.x(), at.y(), at.z(), surface.side(surface.corner_point[corner])};
    };
    const End from = end_at(h), to = end_at(Surface::next(h));
    if (from == to) continue;
    borders.push_back({mesh.skin, {std::min(from, to), std::max(from, to)}, h, to < from});
  }
  return borders;
}

}  // namespace

std::vector<std::array<Index, 2>> find_cracks(const Character& character, const Surface& surface) {
  std::vector<Border> borders = borders_of(character, surface);
  std::sort(borders.begin(), borders.end(), [](const Border& a, const Border& b) {
    return std::tie(a.skin, a.ends, a.half_edge) < std::tie(b.skin, b.ends, b.half_edge);
  });
  std::vector<std::array<Index, 2>> cracks;
  for (std::size_t i = 0, end = 0; i < borders.size(); i = end) {
    for (end = i + 1; end < borders.size() && borders[end].is_beside(borders[i]);) ++end;
    if (end - i != 2 || borders[i].is_reversed == borders[i + 1].is_reversed) continue;
    cracks.push_back({borders[i].half_edge, borders[i + 1].half_edge});
    cracks.push_back({borders[i + 1].half_edge, borders[i].half_edge});
  }
  std::sort(cracks.begin(), cracks.end());
  return cracks;
}

}  // namespace sunder::tear
