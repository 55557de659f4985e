#include "tear/path/crack_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/imprint_point.h"
#include "tear/surface/face_split.h"

namespace sunder::tear {
namespace {

/// A place on a border edge of the source.
struct EdgePlace {
  Index half_edge = kNone;
  double fraction = 0;  ///< From the begin of the half-edge.
};

/// A new point on one side of a crack.
struct CrackPoint {
  Index point = kNone;
  EdgePlace place;
  Index across = kNone;  ///< The half-edge of the other side.

  /// One side has the positions of both.
  [[nodiscard]] bool follows() const { return across < place.half_edge; }
};

/// The part of an edge of the source that holds a place.
struct EdgePart {
  Index half_edge = kNone;
  double fraction = 0;  ///< The place within the part.
};

class CrackMatch {
 public:
  CrackMatch(const EditLog::Mark& since, const Workpiece& work)
      : since_(since),
        work_(work),
        points_(&work.editor.scratch()),
        older_vertices_(&work.editor.scratch()) {
    const std::span<const RowCounts> rows = work.editor.log.mesh_rows_since(since);
    for (std::size_t m = 0; m < rows.size(); ++m)
      older_vertices_.push_back(work.editor.character().meshes[m].vertex_count() -
                                rows[m][Rows::mesh_vertices]);
  }

  Index run() {
    for (Index p = since_.points; p < surface().point_count(); ++p)
      if (const auto place = place_of(p); place && !is_older(surface().point_corner[p]))
        if (const Index across = surface().across_crack(place->half_edge); across != kNone)
          points_.push_back({p, *place, across});
    for (const CrackPoint& of : points_)
      if (!of.follows()) take_position(of, true);
    for (const CrackPoint& of : points_)
      if (of.follows()) take_position(of, false);
    Index blocked = 0;
    for (const CrackPoint& of : points_) blocked += make_partner(of) ? 0 : 1;
    return blocked;
  }

 private:
  [[nodiscard]] const Surface& surface() const { return work_.editor.surface(); }
  [[nodiscard]] Index source_triangles(Index mesh) const {
    return surface().first_triangle[mesh + 1] - surface().first_triangle[mesh];
  }

  [[nodiscard]] Vec3d bind(Index corner) const {
    return work_.editor.births
        .position(surface().triangle(corner / 3).mesh, work_.editor.vertex_at(corner))
        .cast<double>();
  }
  [[nodiscard]] Vec3d bind_of_point(Index point) const {
    return bind(surface().point_corner[point]);
  }
  /// Whether the place of a point was made before: the other lip may still have that point.
  [[nodiscard]] bool is_older(Index corner) const {
    const VertexRef original = work_.editor.births.original(surface().triangle(corner / 3).mesh,
                                                            work_.editor.vertex_at(corner));
    return original.vertex < older_vertices_[original.mesh];
  }
  /// Positions that are nearer to one another are stored as one, or nearly so.
  [[nodiscard]] bool is_same_place(const Vec3d& a, const Vec3d& b) const {
    return norm(Vec3d(a - b)) <= kStoredCoordinates * a.cwiseAbs().maxCoeff();
  }

  /// The place of a point that lies within an edge of the source.
  [[nodiscard]] std::optional<EdgePlace> place_of(Index point) const {
    std::optional<EdgePlace> place;
    if (surface().point_corner[point] == kNone) return place;
    surface().for_each_in_fan(surface().point_corner[point], [&](Index corner) {
      const TriangleRef ref = surface().triangle(corner / 3);
      if (place || ref.source_triangle >= source_triangles(ref.mesh)) return;
      const auto at = work_.editor.source_barycentric(corner);
      const auto zeros = std::count(at.begin(), at.end(), 0.0);
      if (zeros != 1) return;
      const auto apex = static_cast<Index>(std::find(at.begin(), at.end(), 0.0) - at.begin());
      const Index first = 3 * (surface().first_triangle[ref.mesh] + ref.source_triangle);
      const Index edge = Surface::next(first + apex);
      place = EdgePlace{edge,
                        at[Surface::next(edge) % 3] / (at[edge % 3] + at[Surface::next(edge) % 3])};
    });
    return place;
  }

  /// The part of the other side in which the partner of a point lies; none where it was removed.
  [[nodiscard]] EdgePart part_across(const CrackPoint& of) const {
    const Index first = of.across / 3, apex = Surface::previous(of.across) % 3;
    const TriangleRef ref = surface().triangle(first);
    const double wanted = 1 - of.place.fraction;
    EdgePart part;
    work_.editor.origins.for_each_part(ref.mesh, ref.source_triangle, [&](Index face) {
      for (Index h = 3 * face; h < 3 * face + 3 && part.half_edge == kNone; ++h) {
        const auto begin = work_.editor.source_barycentric(h),
                   end = work_.editor.source_barycentric(Surface::next(h));
        if (begin[apex] != 0 || end[apex] != 0) continue;
        const auto fraction = [&](const std::array<double, 3>& at) {
          return at[Surface::next(of.across) % 3] /
                 (at[of.across % 3] + at[Surface::next(of.across) % 3]);
        };
        const double from = fraction(begin), to = fraction(end);
        if (from <= wanted && wanted <= to && from < to) part = {h, (wanted - from) / (to - from)};
      }
    });
    return part;
  }

  /// The corner of the end of a part that is in the place of a point; kNone if neither is.
  [[nodiscard]] Index end_at(const EdgePart& part, Index point) const {
    if (part.half_edge == kNone) return kNone;
    const Vec3d place = bind_of_point(point);
    for (const Index corner : {part.half_edge, Surface::next(part.half_edge)})
      if (is_same_place(bind(corner), place)) return corner;
    return kNone;
  }

  /// Moves a point by rounding to its partner on the other side, if there is one.
  void take_position(const CrackPoint& of, bool only_if_older) {
    const Index partner = end_at(part_across(of), of.point);
    if (partner == kNone) return;
    if (only_if_older && !is_older(partner)) return;
    const Vec3f before = bind_of_point(of.point).cast<float>();
    const Vec3f position = bind(partner).cast<float>();
    if (before == position) return;
    // Both lips of a tear that crosses the crack here, or neither.
    const auto write = [&](const Vec3f& to) {
      bool is_sound = true;
      for (const CrackPoint& other : points_)
        if (other.place.half_edge == of.place.half_edge &&
            other.place.fraction == of.place.fraction) {
          write_position(other.point, to);
          is_sound = is_sound && keeps_winding(other.point);
        }
      return is_sound;
    };
    if (!write(position)) (void)write(before);
  }

  /// Whether no face at a point is turned over in bind space.
  [[nodiscard]] bool keeps_winding(Index point) const {
    bool is_sound = true;
    surface().for_each_in_fan(surface().point_corner[point], [&](Index corner) {
      const TriangleRef ref = surface().triangle(corner / 3);
      const Place now =
          normal(work_.editor, ref.mesh, work_.editor.connectivity.vertices_of(corner / 3));
      const Place of_origin =
          normal(work_.editor, ref.mesh,
                 work_.editor.fillings.origin_triangle(ref.mesh, ref.source_triangle));
      is_sound = is_sound && (dot(now, of_origin) > 0 || dot(of_origin, of_origin) == 0);
    });
    return is_sound;
  }
  void write_position(Index point, const Vec3f& position) {
    surface().for_each_in_fan(surface().point_corner[point], [&](Index corner) {
      const Index mesh = surface().triangle(corner / 3).mesh;
      work_.editor.mutable_mesh(mesh).positions[work_.editor.vertex_at(corner)] = position;
    });
  }

  /// Splits the other side where it has no point in the place of this one.
  bool make_partner(const CrackPoint& of) {
    const EdgePart part = part_across(of);
    if (part.half_edge == kNone) return true;
    if (const Index end = end_at(part, of.point); end != kNone)
      return bind(end) == bind_of_point(of.point);
    const EditLog::Mark before = work_.editor.mark();
    const Index made = split_posed_edge(part.half_edge, part.fraction, work_.editor, work_.posed);
    if (made == kNone) return false;
    write_position(made, bind_of_point(of.point).cast<float>());
    if (keeps_winding(made)) return true;
    work_.editor.roll_back(before);
    work_.posed.forget_from(before.points);
    return false;
  }

  EditLog::Mark since_;
  const Workpiece& work_;
  ScratchVector<CrackPoint> points_;
  ScratchVector<Index> older_vertices_;  ///< Per mesh: the number of those that were there before.
};

}  // namespace

Index match_crack_points(const EditLog::Mark& since, const Workpiece& work) {
  return work.editor.surface().cracks.empty() ? 0 : CrackMatch(since, work).run();
}

}  // namespace sunder::tear
