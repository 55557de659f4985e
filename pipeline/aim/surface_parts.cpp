#include "pipeline/aim/surface_parts.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/internal/ordered.h"
#include "pipeline/aim/joined_sets.h"

namespace sunder::aim {
namespace {

using tear::Surface;

/// A part that holds less of the limb and of other bones than this share of what the limb moves is
/// a scarf between them, not their body; unless it is a large part of the limb and shares so much
/// of itself: a face below much hair and a hat.
constexpr double kLeastShared = 0.02;
/// A large part of the limb holds at least this share of it. Where no part joins it to others,
/// those are its body. A smaller part that joins it is a joint between them: the ball in the hip of
/// a doll.
constexpr double kLeastOfLimb = 0.1;
/// The limb alone moves a part if it moves at least so much of it.
constexpr double kLeastOfProp = 0.9;

/// Where a point lies in bind space, and its side of an older tear, whose lips are apart. In a
/// pose, points with other weights may leave the place.
using Place = std::tuple<float, float, float, Index>;

/// Per point, the first point in the same place.
std::vector<Index> places_of(const PosedSurface& surface) {
  const auto place = [&](Index point) {
    const auto [mesh, vertex] = surface.vertex(point);
    if (mesh == kNone) return Place{0, 0, 0, kNone};
    const Vec3f& at = surface.character().meshes[mesh].positions[vertex];
    return Place{at.x(), at.y(), at.z(), surface.surface().side(point)};
  };
  std::vector<Index> points(surface.surface().point_count()), places(points.size());
  std::iota(points.begin(), points.end(), Index{0});
  std::ranges::sort(points, [&](Index a, Index b) {
    return std::make_pair(place(a), a) < std::make_pair(place(b), b);
  });
  for (std::size_t i = 0, end = 0; i < points.size(); i = end) {
    for (end = i + 1; end < points.size() && place(points[end]) == place(points[i]);) ++end;
    for (std::size_t k = i; k < end; ++k) places[points[k]] = points[i];
  }
  return places;
}

/// Pairs of half-edges in the same place, each with the next one: a fin or an ear on an edge of the
/// body, which has more than two faces there.
std::vector<std::array<Index, 2>> coincident_edges(const PosedSurface& surface,
                                                   const std::vector<Index>& places) {
  std::vector<bool> is_shared(places.size(), false);
  for (Index point = 0; point < places.size(); ++point)
    if (places[point] != point) is_shared[places[point]] = true;
  std::vector<std::array<Index, 3>> edges;  // two places, ascending, and the half-edge
  for (Index h = 0; h < 3 * surface.face_count(); ++h) {
    if (!surface.is_live(h / 3)) continue;
    const Index from = places[surface.point(h)], to = places[surface.point(Surface::next(h))];
    if (!is_shared[from] || !is_shared[to] || from == to) continue;
    edges.push_back({std::min(from, to), std::max(from, to), h});
  }
  std::ranges::sort(edges);
  std::vector<std::array<Index, 2>> pairs;
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i][0] == edges[i - 1][0] && edges[i][1] == edges[i - 1][1])
      pairs.push_back({edges[i - 1][2], edges[i][2]});
  return pairs;
}

}  // namespace

SurfaceParts::SurfaceParts(const Limb& limb) : place_of_point_(places_of(limb.surface)) {
  find_parts(limb.surface);
  measure(limb);
  measure_points(limb.surface);
  choose_body();
}

bool SurfaceParts::is_of_prop(Index face) const {
  const Part& part = parts_[part_of_face_[face]];
  return !is_of_body(face) && part.moved >= kLeastOfProp * part.size;
}

void SurfaceParts::find_parts(const PosedSurface& surface) {
  const Surface& of = surface.surface();
  const Index count = surface.face_count();
  JoinedSets joined(count);
  for (Index h = 0; h < 3 * count; ++h)
    if (of.twin[h] != kNone) joined.join(h / 3, of.twin[h] / 3);
  for (const auto& [a, b] : of.cracks) joined.join(a / 3, b / 3);
  for (const auto& [a, b] : coincident_edges(surface, place_of_point_)) joined.join(a / 3, b / 3);
  // What a cut has separated is one part: the pieces of a triangle have the same origin.
  for (Index face = 0; face < count; ++face) {
    const tear::TriangleRef ref = of.triangle(face);
    const Index origin = of.first_triangle[ref.mesh] + ref.source_triangle;
    if (origin < of.first_triangle[ref.mesh + 1]) joined.join(face, origin);
  }
  std::vector<Index> part_of_set(count, kNone);
  for (Index face = 0; face < count; ++face) {
    Index& part = part_of_set[joined.set_of(face)];
    if (part == kNone) {
      part = static_cast<Index>(parts_.size());
      parts_.emplace_back();
    }
    part_of_face_.push_back(part);
  }
}

void SurfaceParts::measure(const Limb& limb) {
  const Index count = limb.surface.face_count();
  double area = 0, faces = 0;
  for (Index face = 0; face < count; ++face) {
    sizes_.push_back(limb.surface.is_live(face) ? limb.surface.area(face) : 0.0);
    area += sizes_.back();
    faces += limb.surface.is_live(face) ? 1 : 0;
  }
  for (Index face = 0; face < count; ++face) {
    moved_sizes_.push_back(0);
    if (!limb.surface.is_live(face)) continue;
    sizes_[face] = 0.5 / faces + (area > 0 ? 0.5 * sizes_[face] / area : 0.0);
    moved_sizes_[face] = sizes_[face] * limb.bones.shares_of_face(face).limb();
    Part& part = parts_[part_of_face_[face]];
    part.size += sizes_[face];
    part.moved += moved_sizes_[face];
  }
}

void SurfaceParts::measure_points(const PosedSurface& surface) {
  const Index count = surface.surface().point_count();
  std::vector<bool> is_live(count, false);
  std::vector<double> points_there(count, 0.0);
  point_sizes_.assign(count, 0.0);
  double area = 0, places = 0;
  for (Index face = 0; face < surface.face_count(); ++face) {
    if (!surface.is_live(face)) continue;
    const double of_face = surface.area(face);
    area += of_face;
    for (Index corner = 3 * face; corner < 3 * face + 3; ++corner) {
      const Index point = surface.point(corner);
      point_sizes_[point] += of_face / 3;
      if (is_live[point]) continue;
      is_live[point] = true;
      places += points_there[place_of(point)]++ > 0 ? 0 : 1;
    }
  }
  for (Index point = 0; point < count; ++point)
    if (is_live[point])
      point_sizes_[point] = 0.5 / (places * points_there[place_of(point)]) +
                            (area > 0 ? 0.5 * point_sizes_[point] / area : 0.0);
}

void SurfaceParts::choose_body() {
  double whole = 0, most = 0;
  Part* best = nullptr;
  for (const Part& part : parts_) whole += part.moved;
  for (Part& part : parts_) {
    const double shared = std::min(part.moved, part.size - part.moved);
    if (!(shared > most) || part.size < kLeastOfLimb * whole) continue;
    most = shared;
    best = &part;
  }
  const auto joins = [&](const Part& part) {
    return most >= kLeastShared * whole ||
           (part.moved >= kLeastOfLimb * whole && most >= kLeastShared * part.size);
  };
  if (best != nullptr && joins(*best)) {
    best->is_body = true;
    return;
  }
  bool has_body = false;
  for (Part& part : parts_) {
    part.is_body = part.moved > 0 && part.moved >= kLeastOfLimb * whole;
    has_body |= part.is_body;
  }
  if (!has_body)  // a soup of faces
    for (Part& part : parts_) part.is_body = true;
}

}  // namespace sunder::aim
