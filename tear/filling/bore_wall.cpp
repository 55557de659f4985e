#include "tear/filling/bore_wall.h"

#include <algorithm>
#include <cmath>

#include "tear/filling/wall_builder.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {
namespace {

/// The end of a half-edge of a rim and the start of the next.
struct RimPlace {
  Index point = kNone;
  Vec3d at, down;    ///< Posed; down: displacement to the lower edge of the wall.
  double along = 0;  ///< Along the rim, metres.
  Index bottom = kNone;
};

/// Adds a strip that extends downwards from a rim.
void hang_strip(const Rim& rim, std::span<const RimPlace> places, double unit, WallBuilder& walls) {
  const std::size_t count = rim.half_edges.size();
  const auto wall_normal = [&](std::size_t i) {
    return places[i].down.cross(Vec3d(places[i + 1].at - places[i].at));
  };
  WallCorner top, bottom;
  Index mesh = kNone;
  for (std::size_t i = 0; i < count; ++i) {
    const Index h = rim.half_edges[i];
    const auto add_corners = [&](std::size_t at, Index corner) {
      top = walls.add_top(mesh, corner);
      bottom = walls.add_bottom(mesh, top, places[at].bottom, places[at].down);
      // The wall is smooth between two edges, but not where it turns back at a tip.
      const std::size_t before = at > 0 ? at - 1 : rim.is_closed ? count - 1 : 0;
      const std::size_t after = at < count ? at : rim.is_closed ? 0 : count - 1;
      const Vec3d own = unit_or(wall_normal(i), Vec3d::UnitZ());
      const Vec3d mean =
          unit_or(Vec3d(unit_or(wall_normal(before), own) + unit_or(wall_normal(after), own)), own);
      const Vec3d normal = dot(mean, own) > kSmoothWallCosine ? mean : own;
      const Vec3d tangent = unit_or(Vec3d(places[i + 1].at - places[i].at), own.unitOrthogonal());
      walls.shade(mesh, top, normal, tangent, {places[at].along / unit, 0});
      walls.shade(mesh, bottom, normal, tangent,
                  {places[at].along / unit, norm(places[at].down) / unit});
    };
    if (walls.mesh_of(h) != mesh) {
      mesh = walls.mesh_of(h);
      add_corners(i, h);
    }
    const WallCorner top_before = top, bottom_before = bottom;
    add_corners(i + 1, Surface::next(h));
    walls.add_triangle(mesh, h, top, top_before, bottom_before);
    walls.add_triangle(mesh, h, top, bottom_before, bottom);
  }
}

/// The places of a rim, one more than its half-edges; a closed rim ends with its first place.
template <class Down>
ScratchVector<RimPlace> places_of(const Rim& rim, WallBuilder& walls, Down down) {
  ScratchVector<RimPlace> places(&walls.scratch());
  places.reserve(rim.half_edges.size() + 1);
  double along = 0;
  for (std::size_t i = 0; i <= rim.half_edges.size(); ++i) {
    const bool is_last = i == rim.half_edges.size();
    const Index h = rim.half_edges[is_last ? i - 1 : i];
    RimPlace place;
    place.point = walls.surface().corner_point[is_last ? Surface::next(h) : h];
    place.at = walls.position(place.point);
    if (i > 0) along += norm(place.at - places.back().at);
    place.along = along;
    place.down = down(place);
    place.bottom =
        is_last && rim.is_closed ? places.front().bottom : walls.add_point(place.at + place.down);
    places.push_back(place);
  }
  return places;
}

/// A rim that runs once around an axis.
struct Ring {
  Rim rim;
  bool looks_to_drill = false;
  double height = 0;  ///< Mean, along the axis.
};

constexpr double kTurn = 4;  ///< One full turn in units of Axis::angle().

struct Axis {
  Vec3d origin, x, y, z;

  [[nodiscard]] double height(const Vec3d& point) const { return dot(z, point - origin); }
  /// Grows around the axis as the angle does, by kTurn in a full turn. Divisions give the same bits
  /// on every machine, arc tangents do not.
  [[nodiscard]] double angle(const Vec3d& point) const {
    const double u = dot(x, point - origin), v = dot(y, point - origin);
    const double size = std::abs(u) + std::abs(v);
    if (!(size > 0)) return 0;
    return u < 0 ? std::copysign(2.0, v) - v / size : v / size;
  }
  [[nodiscard]] Vec3d inward(const Vec3d& point) const {
    const Vec3d offset = point - origin;
    return unit_or(Vec3d(dot(z, offset) * z - offset), x);
  }
};

double turn(double from, double to) { return std::remainder(to - from, kTurn); }

/// Adds a wall between two rings: `upper` runs in the axis' sense of rotation, `lower` against it.
/// Both are traversed in the direction of the wall's edges, against their borders.
void join_rings(const Ring& upper, const Ring& lower, const Axis& axis, double unit,
                WallBuilder& walls) {
  const Index mesh = walls.mesh_of(upper.rim.half_edges.front());
  struct Place {
    WallCorner corner;
    double angle;
  };
  const auto add_ring = [&](const Rim& rim, double first_angle, bool backwards) {
    ScratchVector<Index> corners(rim.half_edges, &walls.scratch());
    if (backwards) std::reverse(corners.begin(), corners.end());
    // The start is the corner nearest to the start of the other ring.
    const auto angle_of = [&](Index corner) {
      return axis.angle(walls.position(walls.surface().corner_point[corner]));
    };
    const auto nearest = std::min_element(corners.begin(), corners.end(), [&](Index a, Index b) {
      return std::abs(turn(first_angle, angle_of(a))) < std::abs(turn(first_angle, angle_of(b)));
    });
    std::rotate(corners.begin(), nearest, corners.end());
    ScratchVector<Place> places(&walls.scratch());
    places.reserve(corners.size() + 1);
    double along = 0;
    Vec3d before = Vec3d::Zero();
    for (std::size_t i = 0; i <= corners.size(); ++i) {
      const Index corner = corners[i % corners.size()];
      const Vec3d at = walls.position(walls.surface().corner_point[corner]);
      const double angle = i == 0
                               ? first_angle + turn(first_angle, angle_of(corner))
                               : places.back().angle + turn(places.back().angle, angle_of(corner));
      const WallCorner made = walls.add_top(mesh, corner);
      if (i > 0) along += norm(at - before);
      before = at;
      walls.shade(mesh, made, axis.inward(at), axis.z.cross(axis.inward(at)),
                  {along / unit, axis.height(at) / unit});
      places.push_back({made, angle});
    }
    return places;
  };
  const double first =
      axis.angle(walls.position(walls.surface().corner_point[upper.rim.half_edges.front()]));
  const auto above = add_ring(upper.rim, first, false), below = add_ring(lower.rim, first, true);
  const Index like = upper.rim.half_edges.front();
  for (std::size_t i = 0, k = 0; i + 1 < above.size() || k + 1 < below.size();) {
    const bool goes_above =
        k + 1 == below.size() || (i + 1 < above.size() && above[i + 1].angle <= below[k + 1].angle);
    if (goes_above) {
      walls.add_triangle(mesh, like, above[i + 1].corner, above[i].corner, below[k].corner);
      ++i;
    } else {
      walls.add_triangle(mesh, like, above[i].corner, below[k].corner, below[k + 1].corner);
      ++k;
    }
  }
}

/// Adds a wall from a ring down to `depth`, and a floor there.
void add_blind_wall(const Ring& ring, const Axis& axis, double depth, double unit,
                    WallBuilder& walls) {
  const auto places = places_of(ring.rim, walls, [&](const RimPlace& place) -> Vec3d {
    return (depth - axis.height(place.at)) * axis.z;
  });
  hang_strip(ring.rim, places, unit, walls);
  // The floor faces upwards: its outline runs against the lower edge of the wall.
  const Index mesh = walls.mesh_of(ring.rim.half_edges.front());
  FlatLoop loop(&walls.scratch());
  ScratchVector<WallCorner> corners(&walls.scratch());
  loop.reserve(ring.rim.half_edges.size());
  corners.reserve(ring.rim.half_edges.size());
  for (std::size_t i = ring.rim.half_edges.size(); i-- > 0;) {
    const Index h = ring.rim.half_edges[i];
    const Vec3d at = places[i].at + places[i].down;
    loop.emplace_back(-dot(axis.x, at - axis.origin), dot(axis.y, at - axis.origin));
    const WallCorner corner =
        walls.add_bottom(mesh, walls.add_top(mesh, h), places[i].bottom, places[i].down);
    walls.shade(mesh, corner, -axis.z, -axis.x, loop.back() / unit);
    corners.push_back(corner);
  }
  const auto flat =
      triangulate(std::span<const FlatLoop>(&loop, 1), {0, {}}, InnerPoints::none, walls.scratch());
  if (!flat) {
    walls.fail();
    return;
  }
  for (const auto& triangle : flat->triangles)
    walls.add_triangle(mesh, ring.rim.half_edges.front(), corners[triangle[0]],
                       corners[triangle[1]], corners[triangle[2]]);
}

}  // namespace

Index add_bore_wall(std::span<const Index> half_edges, const Vec3d& origin, const Vec3d& z,
                    double depth, Index material, const Workpiece& work) {
  WallBuilder walls(work, material);
  Vec3d x = z.cross(std::abs(z.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY()));
  x /= norm(x);
  const Axis axis{origin, x, z.cross(x), z};
  Index left = 0;
  ScratchVector<Ring> rings(&walls.scratch());
  for (Rim& rim : chain_rims(half_edges, work.editor.surface(), work.editor.scratch())) {
    double around = 0, height = 0;
    for (const Index h : rim.half_edges) {
      const Vec3d a = walls.position(walls.surface().corner_point[h]);
      const Vec3d b = walls.position(walls.surface().corner_point[Surface::next(h)]);
      around += turn(axis.angle(a), axis.angle(b));
      height += axis.height(a) / static_cast<double>(rim.half_edges.size());
    }
    const bool is_ring = rim.is_closed && std::abs(std::abs(around) - kTurn) < kRingQuarterTurns;
    if (is_ring)
      rings.push_back({std::move(rim), around > 0, height});
    else
      ++left;
  }
  std::sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) {
    return a.height != b.height ? a.height < b.height : a.rim.half_edges < b.rim.half_edges;
  });
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Ring& ring = rings[i];
    bool is_built = false;
    if (!ring.looks_to_drill) {
      // The drill started inside the body, so there is nothing to line.
    } else if (i + 1 < rings.size() && !rings[i + 1].looks_to_drill &&
               walls.have_one_skin(ring.rim, rings[i + 1].rim)) {
      const Ring& lower = rings[++i];
      ScratchVector<Index> both(ring.rim.half_edges, &walls.scratch());
      both.insert(both.end(), lower.rim.half_edges.begin(), lower.rim.half_edges.end());
      is_built = walls.add(both, [&] { join_rings(ring, lower, axis, depth, walls); });
    } else {
      is_built =
          walls.add(ring.rim.half_edges, [&] { add_blind_wall(ring, axis, depth, depth, walls); });
    }
    left += is_built ? 0 : 1;
  }
  return left;
}

}  // namespace sunder::tear
