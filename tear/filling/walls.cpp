#include "tear/filling/walls.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/filling/filling.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/section/flat_section.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/rim.h"

namespace sunder::tear {
namespace {

constexpr const char* kName = "wall";

/// A vertex of a wall, and its surface point.
struct Corner {
  Index point = kNone;
  Index vertex = kNone;
};

/// Builds the walls of some borders, one border at a time.
class Walls {
 public:
  explicit Walls(const Workpiece& work) : work_(work), filling_(kName, work) {}

  /// Runs `build`, which adds triangles for some borders, and connects them. @return false if that
  /// fails; then nothing is added.
  template <class Build>
  bool add(std::span<const Index> half_edges, Build build) {
    const EditLog::Mark before = work_.editor.mark();
    is_sound_ = true;
    build();
    if (is_sound_ && filling_.connect(half_edges, before)) return true;
    filling_.take_back(before);
    return false;
  }

  [[nodiscard]] ScratchMemory& scratch() const { return work_.editor.scratch(); }
  [[nodiscard]] const Surface& surface() const { return work_.editor.surface(); }
  [[nodiscard]] Vec3d position(Index point) const {
    return work_.posed.position(work_.editor, point);
  }
  [[nodiscard]] Index mesh_of(Index half_edge) const {
    return surface().triangle(half_edge / 3).mesh;
  }

  /// Rims of different skins cannot share vertices; all points of one rim have the same skin.
  [[nodiscard]] bool have_one_skin(const Rim& a, const Rim& b) const {
    const auto& meshes = work_.editor.character().meshes;
    return meshes[mesh_of(a.half_edges.front())].skin == meshes[mesh_of(b.half_edges.front())].skin;
  }

  [[nodiscard]] Corner add_top(Index mesh, Index corner) {
    return {surface().corner_point[corner], filling_.add_rim_vertex(mesh, corner)};
  }
  /// Adds a vertex at a posed displacement from another one.
  [[nodiscard]] Corner add_bottom(Index mesh, const Corner& top, Index point, const Vec3d& down) {
    const Index vertex = work_.editor.births.append_filling_vertex(mesh, top.vertex);
    Mesh& of = work_.editor.mutable_mesh(mesh);
    const Vec3d bind = to_bind(filling_.blended(mesh, vertex), down, down);
    of.positions[vertex] = (of.positions[vertex].cast<double>() + bind).cast<float>();
    return {point, vertex};
  }
  [[nodiscard]] Index add_point(const Vec3d& at) {
    const Index point = append_filling_point(work_.editor);
    work_.posed.pin(point, at);
    return point;
  }
  void shade(Index mesh, const Corner& corner, const Vec3d& normal, const Vec3d& tangent,
             const Vec2d& uv) {
    filling_.shade(mesh, corner.vertex, normal, tangent, uv);
  }
  void add_triangle(Index mesh, Index like_corner, const Corner& a, const Corner& b,
                    const Corner& c) {
    const auto place = [&](const Corner& of) -> Eigen::Vector3d {
      return work_.editor.births.position(mesh, of.vertex).cast<double>();
    };
    const Eigen::Vector3d ab = place(b) - place(a), ac = place(c) - place(a);
    is_sound_ &= squared_norm(ab.cross(ac)) > 0;  // else stored positions are too coarse for it
    filling_.add_triangle(mesh, like_corner, {a.point, b.point, c.point},
                          {a.vertex, b.vertex, c.vertex});
  }
  void fail() { is_sound_ = false; }

 private:
  Workpiece work_;
  Filling filling_;
  bool is_sound_ = true;
};

Vec3d unit_or(const Vec3d& vector, const Vec3d& otherwise) {
  const double length = norm(vector);
  return length > kShortestDirection ? Vec3d(vector / length) : otherwise;
}

double squared_distance(const Blade& blade, const Vec3d& point) {
  const Vec3d along = blade.tip - blade.base;
  const double at = std::clamp(dot(along, point - blade.base) / squared_norm(along), 0.0, 1.0);
  return squared_norm(point - blade.base - at * along);
}

/// The direction of the blades near a place, weighted by the inverse fourth power of their
/// distances, so that it varies smoothly from one blade to the next.
Vec3d blade_direction(const Stroke& stroke, const Vec3d& at) {
  double nearest = squared_distance(stroke.front(), at);
  for (const Blade& blade : stroke) nearest = std::min(nearest, squared_distance(blade, at));
  Vec3d sum = Vec3d::Zero();
  for (const Blade& blade : stroke) {
    const double squared = squared_distance(blade, at);
    const double ratio =
        squared > 0 ? nearest / squared : 1.0;  // 1 for the nearest blade, in any unit
    sum += ratio * ratio * normalized(blade.tip - blade.base);
  }
  return unit_or(sum, normalized(stroke.front().tip - stroke.front().base));
}

/// The end of a half-edge of a rim and the start of the next.
struct RimPlace {
  Index point = kNone;
  Vec3d at, down;    ///< Posed; down: displacement to the lower edge of the wall.
  double along = 0;  ///< Along the rim, metres.
  Index bottom = kNone;
};

/// Adds a strip that extends downwards from a rim.
void hang_strip(const Rim& rim, std::span<const RimPlace> places, double unit, Walls& walls) {
  const std::size_t count = rim.half_edges.size();
  const auto wall_normal = [&](std::size_t i) {
    return places[i].down.cross(Vec3d(places[i + 1].at - places[i].at));
  };
  Corner top, bottom;
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
    const Corner top_before = top, bottom_before = bottom;
    add_corners(i + 1, Surface::next(h));
    walls.add_triangle(mesh, h, top, top_before, bottom_before);
    walls.add_triangle(mesh, h, top, bottom_before, bottom);
  }
}

/// The places of a rim, one more than its half-edges; a closed rim ends with its first place.
template <class Down>
ScratchVector<RimPlace> places_of(const Rim& rim, Walls& walls, Down down) {
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
void join_rings(const Ring& upper, const Ring& lower, const Axis& axis, double unit, Walls& walls) {
  const Index mesh = walls.mesh_of(upper.rim.half_edges.front());
  struct Place {
    Corner corner;
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
      const Corner made = walls.add_top(mesh, corner);
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
void add_blind_wall(const Ring& ring, const Axis& axis, double depth, double unit, Walls& walls) {
  const auto places = places_of(ring.rim, walls, [&](const RimPlace& place) -> Vec3d {
    return (depth - axis.height(place.at)) * axis.z;
  });
  hang_strip(ring.rim, places, unit, walls);
  // The floor faces upwards: its outline runs against the lower edge of the wall.
  const Index mesh = walls.mesh_of(ring.rim.half_edges.front());
  FlatLoop loop(&walls.scratch());
  ScratchVector<Corner> corners(&walls.scratch());
  loop.reserve(ring.rim.half_edges.size());
  corners.reserve(ring.rim.half_edges.size());
  for (std::size_t i = ring.rim.half_edges.size(); i-- > 0;) {
    const Index h = ring.rim.half_edges[i];
    const Vec3d at = places[i].at + places[i].down;
    loop.emplace_back(-dot(axis.x, at - axis.origin), dot(axis.y, at - axis.origin));
    const Corner corner =
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

Index add_walls(std::span<const Index> half_edges, const Stroke& stroke, double depth,
                const Workpiece& work) {
  Walls walls(work);
  Index count = 0;
  for (const Rim& rim : chain_rims(half_edges, work.editor.surface(), work.editor.scratch())) {
    const bool is_built = walls.add(rim.half_edges, [&] {
      hang_strip(rim,
                 places_of(rim, walls,
                           [&](const RimPlace& place) -> Vec3d {
                             return depth * blade_direction(stroke, place.at);
                           }),
                 depth, walls);
    });
    count += is_built ? 1 : 0;
  }
  return count;
}

Index add_bore_wall(std::span<const Index> half_edges, const Vec3d& origin, const Vec3d& z,
                    double depth, const Workpiece& work) {
  Walls walls(work);
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
