#include "tear/wound_mask/torn_parts.h"

namespace sunder::tear {
namespace {

constexpr double kPlaceRounding = 1e-9;  ///< Of barycentric coordinates.
constexpr double kLipRounding = 1e-8;    ///< The same, for places on lips that were split.

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

/// Whether a place lies on a lip, but for rounding.
bool is_on_a_lip(const PlaceInSource& place, std::span<const LipSegment> lips) {
  return std::any_of(lips.begin(), lips.end(), [&](const LipSegment& lip) {
    const auto& [a, b] = lip.ends;
    const double u = b[1] - a[1], v = b[2] - a[2], square = u * u + v * v;
    if (!(square > 0)) return false;
    const double s = place[1] - a[1], t = place[2] - a[2], along = u * s + v * t;
    return along >= 0 && along <= square &&
           std::abs(u * t - v * s) <= kLipRounding * std::sqrt(square);
  });
}

/// The last operation that began at or before a row of the log. @param rows  its place in Extent.
Index operation_of(Index row, Index EditLog::Extent::*rows,
                   std::span<const EditLog::Extent> begins) {
  const auto after = std::upper_bound(
      begins.begin(), begins.end(), row,
      [&](Index value, const EditLog::Extent& begin) { return value < begin.*rows; });
  return static_cast<Index>(std::max<std::ptrdiff_t>(0, after - begins.begin() - 1));
}

}  // namespace

double area_inside(const std::array<PlaceInSource, 3>& part, const PlaceInSource& place) {
  return std::min({part_area(part[0], part[1], place), part_area(part[1], part[2], place),
                   part_area(part[2], part[0], place)});
}

bool is_filling(Index triangle, const Surface& torn) {
  const TriangleRef ref = torn.triangle(triangle);
  return ref.source_triangle >= torn.first_triangle[ref.mesh + 1] - torn.first_triangle[ref.mesh];
}

bool LeftSkin::is_removed(const PlaceInSource& place) const {
  if (!is_cut_away) return false;
  return std::none_of(parts.begin(), parts.end(), [&](const std::array<PlaceInSource, 3>& part) {
    return area_inside(part, place) >= -kPlaceRounding;
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

TornParts PartFinder::find(Index face, const Surface& source, const SurfaceEditor& torn,
                           const std::optional<EditLog::Extent>& when) const {
  TornParts result;
  const Surface& surface = torn.surface();
  double area_left = 0;
  for_each_part(face, surface, [&](Index part) {
    if (when && part >= when->triangles) return;
    const TriangleRef ref = surface.triangle(part);
    const TriangleChange* const former = when ? torn.log.former(part, *when) : nullptr;
    const Triangle& vertices = former != nullptr
                                   ? former->vertices
                                   : torn.character().meshes[ref.mesh].triangles[ref.triangle];
    if (is_retired(vertices)) return;
    const std::array<PlaceInSource, 3> places = {torn.births.place_in_origin(ref, vertices[0]),
                                                 torn.births.place_in_origin(ref, vertices[1]),
                                                 torn.births.place_in_origin(ref, vertices[2])};
    result.skin.parts.push_back(places);
    area_left += part_area(places[0], places[1], places[2]);
    for (Index k = 0; k < 3; ++k) {
      const Index twin = former != nullptr ? former->twins[k] : surface.twin[3 * part + k];
      if (twin != kNone && !is_filling(twin / 3, surface)) continue;
      const PlaceInSource &a = places[k], &b = places[(k + 1) % 3];
      if (is_in_source_border(face, a, b, source)) continue;
      result.lips.push_back({{std::min(a, b), std::max(a, b)}});
    }
  });
  std::sort(result.lips.begin(), result.lips.end());
  result.lips.erase(std::unique(result.lips.begin(), result.lips.end()), result.lips.end());
  result.skin.is_cut_away = area_left < 1 - kPlaceRounding;
  if (!result.skin.is_cut_away) result.skin.parts.clear();
  return result;
}

std::vector<Index> PartFinder::operations_of(Index face, std::span<const LipSegment> lips,
                                             const Surface& source, const SurfaceEditor& torn,
                                             std::span<const EditLog::Extent> begins) const {
  std::vector<Index> changed_by;  // the operations that changed a part
  const Index first = torn.surface().first_triangle.back();
  for_each_part(face, torn.surface(), [&](Index part) {
    if (part >= first)
      changed_by.push_back(operation_of(part, &EditLog::Extent::triangles, begins));
    torn.log.for_each_change_of(part, [&](Index change) {
      changed_by.push_back(operation_of(change, &EditLog::Extent::triangle_changes, begins));
    });
  });
  std::sort(changed_by.begin(), changed_by.end());
  changed_by.erase(std::unique(changed_by.begin(), changed_by.end()), changed_by.end());
  std::vector<Index> made_by(lips.size(), changed_by.empty() ? 0 : changed_by.front());
  std::vector<bool> is_known(lips.size(), false);
  for (std::size_t i = changed_by.size(); i-- > 1;) {
    const TornParts before = find(face, source, torn, begins[changed_by[i]]);
    for (std::size_t k = 0; k < lips.size(); ++k) {
      const auto& [a, b] = lips[k].ends;
      const PlaceInSource middle = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
      if (is_known[k] || is_on_a_lip(middle, before.lips)) continue;
      made_by[k] = changed_by[i];
      is_known[k] = true;
    }
  }
  return made_by;
}

}  // namespace sunder::tear
