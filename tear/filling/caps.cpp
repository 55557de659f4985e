#include "tear/filling/caps.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/filling/cap_rim.h"
#include "tear/filling/cap_shapes.h"
#include "tear/filling/divided_cap.h"
#include "tear/filling/filling.h"
#include "tear/filling/flat_triangles.h"
#include "tear/filling/part_points.h"
#include "tear/filling/rim_values.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/section/exact_predicates.h"
#include "tear/section/flat_section.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/rim.h"

namespace sunder::tear {
namespace {

/// A frame in the plane of the section. Both sides of a cut use the same one, so that their rims
/// have the same places.
struct SectionFrame {
  Vec3d origin, x, y, normal;

  [[nodiscard]] Vec2d project(const Vec3d& point) const {
    return {dot(x, point - origin), dot(y, point - origin)};
  }
  [[nodiscard]] Vec3d lift(const Vec2d& point) const {
    return origin + point.x() * x + point.y() * y;
  }
};

/// The side of a cut whose caps are made, by the direction in which they face.
enum class Facing : std::uint8_t { along_normal, against_normal };

/// Decided exactly: triangulate() takes loops of any size, down to one unit in the last place.
bool is_clockwise(const FlatLoop& loop, ScratchMemory& scratch) {
  const ScratchMemory::Frame frame(scratch);
  ScratchVector<Vec2d> points(&scratch);
  points.reserve(loop.size());
  for (const Vec2d& point : loop) points.push_back(exact_range(point).value_or(Vec2d::Zero()));
  return area_sign(points) < 0;
}

/// The caps of one side.
class Caps {
 public:
  Caps(const SectionFrame& frame, Facing facing, Index material, CapShapes& shapes,
       const Workpiece& work, TearReport& report)
      : frame_(frame),
        facing_(facing),
        shapes_(shapes),
        work_(work),
        report_(report),
        filling_("cap", work, material) {}

  /// @param following  see SheetOpening.
  void add(std::span<const Index> half_edges, std::span<const std::array<Index, 2>> following) {
    const Surface& surface = work_.editor.surface();
    ScratchVector<Rim> rims = chain_rims(half_edges, following, surface, scratch());
    ScratchVector<std::array<Index, 2>> closed_by_skin(&scratch());
    closed_by_skin.reserve(rims.size());
    for (Index i = 0; i < rims.size(); ++i) {
      if (!rims[i].is_closed) {
        ++report_.open_sections;
        continue;
      }
      const Index mesh = surface.triangle(rims[i].half_edges.front() / 3).mesh;
      // A cap runs in the opposite direction of the border that it closes. Those of the side that
      // faces against the normal are made as if seen from behind.
      if (facing_ == Facing::along_normal)
        std::reverse(rims[i].half_edges.begin(), rims[i].half_edges.end());
      closed_by_skin.push_back({work_.editor.character().meshes[mesh].skin, i});
    }
    std::sort(closed_by_skin.begin(), closed_by_skin.end());
    for (auto first = closed_by_skin.begin(); first != closed_by_skin.end();) {
      const auto end = std::find_if(first, closed_by_skin.end(),
                                    [&](const auto& of) { return of[0] != (*first)[0]; });
      ScratchVector<Rim*> of_skin(&scratch());
      for (; first != end; ++first) of_skin.push_back(&rims[(*first)[1]]);
      close(of_skin);
    }
  }

 private:
  [[nodiscard]] ScratchMemory& scratch() const { return work_.editor.scratch(); }

  void close(std::span<Rim* const> rims) {
    ScratchVector<FlatLoop> loops(&scratch());
    loops.reserve(rims.size());
    for (Rim* rim : rims) {
      FlatLoop& loop = loops.emplace_back();
      loop.reserve(rim->half_edges.size());
      for (const Index h : rim->half_edges)
        loop.push_back(frame_.project(position(point_before(h))));
      part_touching_points(loop, scratch());
      // The same start on both sides.
      const auto first = std::min_element(loop.begin(), loop.end(), is_left_of) - loop.begin();
      std::rotate(loop.begin(), loop.begin() + first, loop.end());
      std::rotate(rim->half_edges.begin(), rim->half_edges.begin() + first, rim->half_edges.end());
    }
    std::size_t left_over = rims.size();
    for (FlatRegion& region : find_regions(loops, scratch())) {
      std::sort(region.holes.begin(), region.holes.end(), [&](Index a, Index b) {
        return loops[a][0] != loops[b][0] ? is_left_of(loops[a][0], loops[b][0]) : a < b;
      });
      const EditLog::Mark before = work_.editor.mark();
      CapShape* shape = shapes_.of(loops, region);
      if (shape == nullptr && part_close_points(region, loops)) shape = shapes_.of(loops, region);
      if (shape != nullptr && close(rims, loops, region, *shape, before)) {
        ++report_.caps;
        left_over -= 1 + region.holes.size();
      } else {
        filling_.take_back(before);
      }
    }
    report_.open_sections += static_cast<Index>(left_over);
  }

  /// @return whether there are any.
  bool part_close_points(const FlatRegion& region, std::span<FlatLoop> loops) const {
    double largest = frame_.origin.cwiseAbs().maxCoeff();
    for (const Vec2d& place : loops[region.outline])
      largest = std::max(largest, place.cwiseAbs().maxCoeff());
    const double close = kStoredCoordinates * largest;
    bool has_moved = tear::part_close_points(loops[region.outline], close);
    for (const Index hole : region.holes)
      if (tear::part_close_points(loops[hole], close)) has_moved = true;
    return has_moved;
  }

  [[nodiscard]] Index point_before(Index half_edge) const {
    return CapRim::point_before(half_edge, work_.editor.surface());
  }
  [[nodiscard]] Vec3d position(Index point) const {
    return work_.posed.position(work_.editor, point);
  }

  bool close(std::span<Rim* const> rims, std::span<const FlatLoop> loops, const FlatRegion& region,
             CapShape& shape, const EditLog::Mark& before) {
    CapRim rim(scratch());
    rim.half_edges.reserve(shape.rim_count);
    rim.places = std::span(shape.places).first(shape.rim_count);
    const auto append = [&](Index loop) {
      rim.half_edges.insert(rim.half_edges.end(), rims[loop]->half_edges.begin(),
                            rims[loop]->half_edges.end());
    };
    append(region.outline);
    for (const Index hole : region.holes) append(hole);
    CapShape own(scratch());  // if this side needs other points
    CapShape& of = divide_cap(rim, shape, work_.editor.surface(), own) ? own : shape;

    const Index mesh = mesh_with_most(rim.half_edges);
    ScratchVector<Index> points(&scratch()), vertices(&scratch());
    points.reserve(of.places.size());
    vertices.reserve(of.places.size());
    for (const Index h : rim.half_edges) {
      points.push_back(point_before(h));
      vertices.push_back(filling_.add_rim_vertex(mesh, Surface::next(h)));
    }
    // A body whose faces point inwards has reversed rims.
    const bool is_inside_out = is_clockwise(loops[region.outline], scratch());
    const bool is_copy = is_like_first(mesh, is_inside_out, of, vertices);
    if (is_copy)
      copy_inner_points(mesh, of, points, vertices);
    else
      add_inner_points(mesh, of, points, vertices);
    shade(mesh, of, is_inside_out, is_copy, vertices);
    if (!add_triangles(rim, mesh, of, is_inside_out, is_copy, points, vertices, before))
      return false;
    if (&of == &shape && shape.first_cap.mesh == kNone)
      shape.first_cap = {mesh, is_inside_out, shape.first_cap.is_flat, std::move(vertices)};
    return true;
  }

  /// Adds the triangles and connects them. @return false if that fails.
  bool add_triangles(const CapRim& rim, Index mesh, CapShape& shape, bool is_inside_out,
                     bool is_copy, std::span<const Index> points, std::span<const Index> vertices,
                     const EditLog::Mark& before) {
    const FlatMesh& flat = shape.flat;
    ScratchVector<FlatTriangle> turned(&scratch());
    // What has the same places in bind space has the same triangles without area.
    const CapVertices cap{mesh, vertices};
    if (!is_copy) shape.first_cap.is_flat = has_flat_triangles(flat.triangles, cap, work_.editor);
    if (shape.first_cap.is_flat) {
      turned = flat.triangles;
      if (!turn_flat_triangles(turned, cap, rim, work_.editor)) return false;
    }
    const std::span<const FlatTriangle> triangles =
        shape.first_cap.is_flat ? turned : flat.triangles;
    const bool is_swapped = is_inside_out != (facing_ == Facing::against_normal);
    const std::array<std::size_t, 3> order = {0, is_swapped ? 2u : 1u, is_swapped ? 1u : 2u};
    const Index first = work_.editor.surface().triangle_count();
    for (const FlatTriangle& corners : triangles) {
      const Index a = corners[order[0]], b = corners[order[1]], c = corners[order[2]];
      filling_.add_triangle(mesh, rim.half_edges.front(), {points[a], points[b], points[c]},
                            {vertices[a], vertices[b], vertices[c]});
    }
    if (shape.first_cap.is_flat || flat.twins.empty())
      return filling_.connect(rim.half_edges, before);
    connect_as(flat, rim, first, is_swapped);
    return true;
  }

  /// Connects the triangles from `first` on, which are those of a flat mesh. No edge between points
  /// of the rim is joined to another face, see joined_edges().
  void connect_as(const FlatMesh& flat, const CapRim& rim, Index first, bool is_swapped) const {
    const auto half_edge_of = [&](Index flat_edge) {
      const Index k = flat_edge % 3;
      return 3 * (first + flat_edge / 3) + (is_swapped ? 2 - k : k);
    };
    const auto rim_count = static_cast<Index>(rim.half_edges.size());
    for (Index edge = 0; edge < flat.twins.size(); ++edge) {
      const Index twin = flat.twins[edge];
      if (twin != kNone) {
        if (edge < twin) work_.editor.connectivity.join(half_edge_of(edge), half_edge_of(twin));
        continue;
      }
      // The border runs against the cap: it ends where the cap's edge begins.
      const FlatTriangle& corners = flat.triangles[edge / 3];
      const Index begin = corners[(is_swapped ? edge + 1 : edge) % 3];
      if (begin < rim_count) connect(half_edge_of(edge), rim.half_edges[begin], work_.editor);
    }
  }

  [[nodiscard]] Index mesh_with_most(std::span<const Index> half_edges) const {
    ScratchVector<Index> count(work_.editor.character().meshes.size(), 0, &scratch());
    for (const Index h : half_edges) ++count[work_.editor.surface().triangle(h / 3).mesh];
    return static_cast<Index>(std::max_element(count.begin(), count.end()) - count.begin());
  }

  /// Adds the inner points. Bind positions, weights and morph displacements are harmonic between
  /// those of the rim.
  void add_inner_points(Index mesh, CapShape& shape, ScratchVector<Index>& points,
                        ScratchVector<Index>& vertices) {
    if (shape.flat.inner.empty()) return;
    const ScratchMemory::Frame frame(scratch());  // points and vertices have room
    RimValues of_rim(mesh, vertices, work_.editor);
    ScratchVector<double> rows = of_rim.rows(vertices, shape.places.size());
    extend_harmonically(shape.places, shape.flat, of_rim.channels(), rows, scratch());
    for (std::size_t i = shape.rim_count; i < shape.places.size(); ++i) {
      const RimValues::Vertex vertex = of_rim.vertex_of(&rows[i * of_rim.channels()]);
      vertices.push_back(filling_.add_inner_vertex(
          mesh, vertices.front(),
          {vertex.bind_position, vertex.influences, vertex.morph_displacements}));
      add_inner_point(shape.places[i], points);
    }
  }

  /// Adds the inner points with the vertices of the other side's cap.
  void copy_inner_points(Index mesh, const CapShape& shape, ScratchVector<Index>& points,
                         ScratchVector<Index>& vertices) {
    for (std::size_t i = shape.rim_count; i < shape.places.size(); ++i) {
      vertices.push_back(
          work_.editor.births.append_filling_vertex(mesh, shape.first_cap.vertices[i]));
      add_inner_point(shape.places[i], points);
    }
  }

  void add_inner_point(const Vec2d& place, ScratchVector<Index>& points) {
    points.push_back(append_filling_point(work_.editor));
    work_.posed.pin(points.back(), frame_.lift(place));
  }

  /// Whether the rim has the same values as that of the cap that was made from the shape first, so
  /// that the inner points have them too.
  [[nodiscard]] bool is_like_first(Index mesh, bool is_inside_out, const CapShape& shape,
                                   std::span<const Index> vertices) const {
    const CapShape::Cap& first = shape.first_cap;
    if (first.mesh != mesh || first.is_inside_out != is_inside_out) return false;
    for (std::size_t i = 0; i < shape.rim_count; ++i)
      if (!RimValues::are_same(mesh, first.vertices[i], vertices[i], work_.editor)) return false;
    return true;
  }

  /// @param is_copy  the vertices are like those of the cap that was made first, which faces in the
  ///         opposite direction.
  void shade(Index mesh, const CapShape& shape, bool is_inside_out, bool is_copy,
             std::span<const Index> vertices) {
    const std::span<const Vec2d> places(shape.places);
    Vec2d low = places[0], high = places[0];
    for (const Vec2d& place : places) {
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
    const double extent = (high - low).maxCoeff();
    const bool is_from_behind = facing_ == Facing::against_normal;
    const Vec3d normal = is_inside_out != is_from_behind ? Vec3d(-frame_.normal) : frame_.normal;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vec2d at(places[i].x() - low.x(),
                     is_from_behind ? high.y() - places[i].y() : places[i].y() - low.y());
      if (is_copy)
        filling_.shade_from_behind(mesh, vertices[i], shape.first_cap.vertices[i], at / extent);
      else
        filling_.shade(mesh, vertices[i], normal, frame_.x, at / extent);
    }
  }

  SectionFrame frame_;
  Facing facing_;
  CapShapes& shapes_;
  Workpiece work_;
  TearReport& report_;
  Filling filling_;
};

/// Where the section touches itself, no cap may have joined some fans of a point.
void separate_uncapped(const SheetOpening& opening, const Workpiece& work,
                       std::vector<LipPair>& lips) {
  ScratchVector<Index> corners(&work.editor.scratch());
  for (const auto* following : {&opening.left_following, &opening.right_following})
    for (const auto& [arriving, leaving] : *following) {
      corners.push_back(Surface::next(arriving));
      corners.push_back(leaving);
    }
  const std::size_t first_lip = lips.size();
  separate_loose_fans(corners, work.editor, lips);
  for (std::size_t i = first_lip; i < lips.size(); ++i)
    work.posed.pin(lips[i].left, Vec3d(work.posed.position(work.editor, lips[i].right)));
}

}  // namespace

void add_caps(const SheetOpening& opening, const Vec3d& normal, Index material,
              const Workpiece& work, TearReport& report, std::vector<LipPair>& lips) {
  if (opening.edges.empty()) return;
  const Vec3d origin = work.posed.position(work.editor, opening.edges.front()[0]);
  const Vec3d away = std::abs(normal.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY());
  Vec3d x = normal.cross(away);
  x /= norm(x);
  const SectionFrame frame{origin, x, normal.cross(x), normal};
  CapShapes shapes(work.editor.scratch());
  Caps(frame, Facing::against_normal, material, shapes, work, report)
      .add(opening.left, opening.left_following);
  Caps(frame, Facing::along_normal, material, shapes, work, report)
      .add(opening.right, opening.right_following);
  separate_uncapped(opening, work, lips);
}

}  // namespace sunder::tear
