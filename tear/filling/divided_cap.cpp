#include "tear/filling/divided_cap.h"

#include <algorithm>
#include <array>

namespace sunder::tear {
namespace {

/// Whether the cap is that of an isolated face: two faces on the same three points could not be
/// split separately.
bool is_second_face(const CapRim& rim, const FlatMesh& flat) {
  return flat.triangles.size() == 1 &&
         std::all_of(rim.half_edges.begin(), rim.half_edges.end(),
                     [&](Index h) { return h / 3 == rim.half_edges.front() / 3; });
}

/// Adds a point in the middle of the only triangle.
void split_second_face(const CapRim& rim, FlatMesh& flat) {
  const auto [a, b, c] = flat.triangles[0];
  const auto middle = static_cast<Index>(rim.places.size());
  flat.inner.push_back((rim.places[a] + rim.places[b] + rim.places[c]) / 3);
  flat.triangles.assign({{a, b, middle}, {b, c, middle}, {c, a, middle}});
}

/// The edges between points of the rim that are joined, ascending.
ScratchVector<std::array<Index, 2>> joined_edges(const CapRim& rim, const FlatMesh& flat,
                                                 const Surface& surface) {
  ScratchVector<std::array<Index, 2>> joined(rim.half_edges.get_allocator());
  const auto follows = [&](Index a, Index b) {
    return surface.corner_point[rim.half_edges[a]] ==
           CapRim::point_before(rim.half_edges[b], surface);
  };
  for (const FlatTriangle& corners : flat.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = corners[k], b = corners[(k + 1) % 3];
      if (a >= rim.size() || b >= rim.size()) continue;
      // An edge between two triangles is looked up once.
      if (a > b && !follows(a, b) && !follows(b, a)) continue;
      if (rim.is_joined(a, b, surface)) joined.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(joined.begin(), joined.end());
  joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
  return joined;
}

/// Adds a point in the middle of each of some edges.
void split_edges(std::span<const std::array<Index, 2>> joined, const CapRim& rim, FlatMesh& flat) {
  const auto first = static_cast<Index>(rim.places.size() + flat.inner.size());
  for (const auto [a, b] : joined) flat.inner.push_back(0.5 * (rim.places[a] + rim.places[b]));
  for (std::size_t t = 0; t < flat.triangles.size();
       ++t)  // parts are appended, and looked at in their turn
    for (std::size_t k = 0; k < 3;) {
      const Index a = flat.triangles[t][k], b = flat.triangles[t][(k + 1) % 3],
                  c = flat.triangles[t][(k + 2) % 3];
      const std::array<Index, 2> edge{std::min(a, b), std::max(a, b)};
      const auto found = std::lower_bound(joined.begin(), joined.end(), edge);
      if (found == joined.end() || *found != edge) {
        ++k;
        continue;
      }
      const Index middle = first + static_cast<Index>(found - joined.begin());
      flat.triangles[t] = {a, middle, c};
      flat.triangles.push_back({middle, b, c});
      k = 0;
    }
}

}  // namespace

bool divide_cap(const CapRim& rim, const CapShape& shape, const Surface& surface, CapShape& own) {
  const bool is_second = is_second_face(rim, shape.flat);
  const ScratchVector<std::array<Index, 2>> joined = joined_edges(rim, shape.flat, surface);
  if (!is_second && joined.empty()) return false;
  own.rim_count = shape.rim_count;
  own.flat = shape.flat;
  own.flat.twins.clear();
  if (is_second) split_second_face(rim, own.flat);
  split_edges(joined, rim, own.flat);
  own.places.assign(rim.places.begin(), rim.places.end());
  own.places.insert(own.places.end(), own.flat.inner.begin(), own.flat.inner.end());
  return true;
}

}  // namespace sunder::tear
