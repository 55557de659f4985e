#include "tear/bodies/parts.h"

#include <algorithm>
#include <limits>

#include "core/internal/ordered.h"

namespace sunder::bodies {
namespace {

/// A part while parts are joined.
struct Growing {
  Part part;
  double area = 0;
  double largest = 0;            ///< Area of the part that gave its number.
  Vec3d moment = Vec3d::Zero();  ///< Area times centroid.

  [[nodiscard]] Vec3d centroid() const { return area > 0 ? Vec3d(moment / area) : moment; }
};

bool is_before(const Vec3d& a, const Vec3d& b) {
  for (int i = 0; i < 3; ++i)
    if (a[i] != b[i]) return a[i] < b[i];
  return false;
}

void sort_and_unite(std::vector<std::uint32_t>& vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

std::vector<Growing> collect(std::span<const Vec3d> positions, std::span<const Triangle> triangles,
                             std::span<const std::uint32_t> part_of_triangle) {
  std::vector<std::uint32_t> numbers;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (!is_retired(triangles[t])) numbers.push_back(part_of_triangle[t]);
  sort_and_unite(numbers);
  std::vector<Growing> parts(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) parts[i].part.number = numbers[i];
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (is_retired(triangles[t])) continue;
    const auto at = std::lower_bound(numbers.begin(), numbers.end(), part_of_triangle[t]);
    Growing& part = parts[static_cast<std::size_t>(at - numbers.begin())];
    const Vec3d &a = positions[triangles[t][0]], &b = positions[triangles[t][1]],
                &c = positions[triangles[t][2]];
    const double area = 0.5 * norm(Vec3d((b - a).cross(c - a)));
    part.area += area;
    part.moment += area / 3 * (a + b + c);
    part.part.vertices.insert(part.part.vertices.end(), triangles[t].begin(), triangles[t].end());
  }
  for (Growing& part : parts) {
    sort_and_unite(part.part.vertices);
    part.largest = part.area;
  }
  return parts;
}

/// The places of a part's vertices, sorted.
std::vector<Vec3d> places_of(const Growing& part, std::span<const Vec3d> positions) {
  std::vector<Vec3d> places;
  for (const std::uint32_t vertex : part.part.vertices) places.push_back(positions[vertex]);
  std::sort(places.begin(), places.end(), is_before);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

std::size_t count_shared(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  std::size_t shared = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (is_before(a[i], b[j])) {
      ++i;
    } else if (is_before(b[j], a[i])) {
      ++j;
    } else {
      ++shared, ++i, ++j;
    }
  }
  return shared;
}

/// The part that `leaving` joins.
std::size_t neighbour_of(std::size_t leaving, const std::vector<Growing>& parts,
                         const std::vector<std::vector<Vec3d>>& places) {
  std::size_t best = parts.size(), most_shared = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == leaving) continue;
    const std::size_t shared = count_shared(places[leaving], places[i]);
    const double away = norm(Vec3d(parts[i].centroid() - parts[leaving].centroid()));
    if (best < parts.size() &&
        (shared < most_shared || (shared == most_shared && !(away < nearest))))
      continue;
    best = i;
    most_shared = shared;
    nearest = away;
  }
  return best;
}

}  // namespace

std::vector<Part> join_parts(std::span<const Vec3d> positions, std::span<const Triangle> triangles,
                             std::span<const std::uint32_t> part_of_triangle, std::uint32_t most) {
  std::vector<Growing> parts = collect(positions, triangles, part_of_triangle);
  std::vector<std::vector<Vec3d>> places;
  if (parts.size() > most)
    for (const Growing& part : parts) places.push_back(places_of(part, positions));
  while (parts.size() > most) {
    const auto least =
        std::min_element(parts.begin(), parts.end(),
                         [](const Growing& a, const Growing& b) { return a.area < b.area; });
    const auto leaving = static_cast<std::size_t>(least - parts.begin());
    const std::size_t joined = neighbour_of(leaving, parts, places);
    Growing &from = parts[leaving], &to = parts[joined];
    if (from.largest > to.largest) {
      to.part.number = from.part.number;
      to.largest = from.largest;
    }
    to.area += from.area;
    to.moment += from.moment;
    to.part.vertices.insert(to.part.vertices.end(), from.part.vertices.begin(),
                            from.part.vertices.end());
    sort_and_unite(to.part.vertices);
    places[joined] = places_of(to, positions);
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(leaving));
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(leaving));
  }
  std::vector<Part> joined;
  for (Growing& part : parts) joined.push_back(std::move(part.part));
  std::sort(joined.begin(), joined.end(),
            [](const Part& a, const Part& b) { return a.number < b.number; });
  return joined;
}

}  // namespace sunder::bodies
