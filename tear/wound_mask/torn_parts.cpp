#include "tear/wound_mask/torn_parts.h"

namespace sunder::tear {
namespace {

constexpr double kPlaceRounding = 1e-9;  ///< Of barycentric coordinates.

using PlaceInSource = std::array<double, 3>;

/// Twice the area of a triangle of places, in areas of the whole triangle.
double part_area(const PlaceInSource& a, const PlaceInSource& b, const PlaceInSource& c) {
  return (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]);
}

/// Whether an edge of a part lies in a border of the source.
bool is_in_source_border(Index face, const PlaceInSource& a, const PlaceInSource& b,
                         const Surface& source) {
  for (Index k = 0; k < 3; ++k)
    if (a[k] == 0 && b[k] == 0 && source.twin[Surface::next(3 * face + k)] == kNone) return true;
  return false;
}

bool is_filling(Index triangle, const Surface& torn) {
  const TriangleRef ref = torn.triangle(triangle);
  return ref.source_triangle >= torn.first_triangle[ref.mesh + 1] - torn.first_triangle[ref.mesh];
}

}  // namespace

bool TornParts::is_removed(const PlaceInSource& place) const {
  if (!is_cut_away) return false;
  return std::none_of(parts.begin(), parts.end(), [&](const std::array<PlaceInSource, 3>& part) {
    return part_area(part[0], part[1], place) >= -kPlaceRounding &&
           part_area(part[1], part[2], place) >= -kPlaceRounding &&
           part_area(part[2], part[0], place) >= -kPlaceRounding;
  });
}

void PartFinder::follow(const Surface& torn) {
  const auto count = torn.appended.size();
  while (appended_.size() > count) {
    const Appended last = appended_.back();
    appended_.pop_back();
    if (last.origin != kNone) newest_[last.origin] = last.previous;
  }
  while (appended_.size() < count) {
    const auto triangle = torn.first_triangle.back() + static_cast<Index>(appended_.size());
    if (is_filling(triangle, torn)) {
      appended_.push_back({kNone, kNone});
      continue;
    }
    const TriangleRef ref = torn.triangle(triangle);
    const Index origin = torn.first_triangle[ref.mesh] + ref.source_triangle;
    appended_.push_back({origin, newest_[origin]});
    newest_[origin] = triangle;
  }
}

TornParts PartFinder::find(Index face, const Surface& source, const SurfaceEditor& torn) const {
  TornParts result;
  const Surface& surface = torn.surface();
  double area_left = 0;
  const auto look_at = [&](Index part) {
    const TriangleRef ref = surface.triangle(part);
    if (is_retired(torn.character().meshes[ref.mesh].triangles[ref.triangle])) return;
    const std::array<PlaceInSource, 3> places = {torn.source_barycentric(3 * part),
                                                 torn.source_barycentric(3 * part + 1),
                                                 torn.source_barycentric(3 * part + 2)};
    result.parts.push_back(places);
    area_left += part_area(places[0], places[1], places[2]);
    for (Index k = 0; k < 3; ++k) {
      const Index twin = surface.twin[3 * part + k];
      if (twin != kNone && !is_filling(twin / 3, surface)) continue;
      const PlaceInSource &a = places[k], &b = places[(k + 1) % 3];
      if (is_in_source_border(face, a, b, source)) continue;
      result.lips.push_back({{std::min(a, b), std::max(a, b)}});
    }
  };
  look_at(face);
  const Index first = surface.first_triangle.back();
  for (Index p = newest_[face]; p != kNone; p = appended_[p - first].previous) look_at(p);
  std::sort(result.lips.begin(), result.lips.end());
  result.lips.erase(std::unique(result.lips.begin(), result.lips.end()), result.lips.end());
  result.is_cut_away = area_left < 1 - kPlaceRounding;
  if (!result.is_cut_away) result.parts.clear();
  return result;
}

}  // namespace sunder::tear
