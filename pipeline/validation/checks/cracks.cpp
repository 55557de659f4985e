#include "pipeline/validation/checks/cracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/internal/ordered.h"
#include "pipeline/validation/checks/deviation.h"
#include "pipeline/validation/checks/inherited.h"
#include "pipeline/validation/match/position_table.h"

namespace sunder::validation {
namespace {

constexpr double kOnEdge = 1e-6;  ///< Of the diagonal.

std::pair<Index, Index> in_mesh(const BindSurface& surface, Index vertex) {
  const Index mesh = surface.mesh_of_vertex(vertex);
  return {mesh, vertex - surface.first_vertex[mesh]};
}

/// Whether two vertices of one skin have the same influences, in any order.
bool same_weights(std::span<const Influence> a, std::span<const Influence> b) {
  if (a.size() != b.size()) return false;
  if (std::equal(a.begin(), a.end(), b.begin())) return true;
  return std::ranges::all_of(
      a, [&](const Influence& influence) { return std::ranges::count(b, influence) == 1; });
}

/// The points of border edges by cells of space.
struct BorderGrid {
  using Cell = std::array<std::int64_t, 3>;
  double size = 0.0;  ///< Of a cell, metres.
  std::map<Cell, std::vector<Index>> points;

  [[nodiscard]] Cell cell_at(const Vec3d& place) const {
    Cell cell;
    for (std::size_t i = 0; i < 3; ++i)
      cell[i] = static_cast<std::int64_t>(std::floor(place[static_cast<int>(i)] / size));
    return cell;
  }
  /// Calls visit(point) for all points in the cells from low to high, in the order of the cells.
  /// Skips cells outside, so that long edges in a fine grid cost only the columns in use.
  template <class Visit>
  void visit_box(const Cell& low, const Cell& high, Visit visit) const {
    for (auto at = points.lower_bound(low); at != points.end() && at->first <= high;) {
      const auto& [x, y, z] = at->first;
      if (y < low[1] || (y == low[1] && z < low[2])) {
        at = points.lower_bound({x, low[1], low[2]});
      } else if (y > high[1]) {
        at = points.lower_bound({x + 1, low[1], low[2]});
      } else if (z < low[2]) {
        at = points.lower_bound({x, y, low[2]});
      } else if (z > high[2]) {
        at = points.lower_bound({x, y + 1, low[2]});
      } else {
        for (const Index point : at->second) visit(point);
        ++at;
      }
    }
  }
};

std::vector<PointGraph::Edge> border_edges(const PointGraph& graph) {
  std::vector<PointGraph::Edge> edges;
  for (const auto& edge : graph.edges)
    if (edge.faces == 1) edges.push_back(edge);
  return edges;
}

const Vec3d& place_of(const Skinned& skin, Index point) {
  return skin.surface.positions[skin.graph.vertex_of_point[point]];
}

BorderGrid make_grid(const Skinned& skin, std::span<const PointGraph::Edge> borders) {
  BorderGrid grid;
  double sum = 0.0;
  std::vector<Index> points;
  for (const auto& edge : borders) {
    sum += norm(place_of(skin, edge.a) - place_of(skin, edge.b));
    points.push_back(edge.a);
    points.push_back(edge.b);
  }
  grid.size = std::max(2.0 * sum / static_cast<double>(std::max<std::size_t>(borders.size(), 1)),
                       1e-9 + 1e-3 * skin.surface.diagonal);
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const Index point : points)
    grid.points[grid.cell_at(place_of(skin, point))].push_back(point);
  return grid;
}

/// A border point on the inside of an edge.
struct OnEdge {
  double t = 0.0;
  Index point = 0;
};

/// All border points on the inside of an edge, from a to b.
std::vector<OnEdge> points_on(const Skinned& skin, const BorderGrid& grid,
                              const PointGraph::Edge& edge) {
  const Vec3d &a = place_of(skin, edge.a), &b = place_of(skin, edge.b);
  const double tolerance = kOnEdge * skin.surface.diagonal, square = squared_norm(b - a);
  std::vector<OnEdge> found;
  grid.visit_box(grid.cell_at(a.cwiseMin(b)), grid.cell_at(a.cwiseMax(b)), [&](Index point) {
    const Vec3d& p = place_of(skin, point);
    const double t = dot(p - a, b - a) / square;
    const Vec3d foot = a + t * (b - a);
    if (t <= 0.0 || t >= 1.0 || norm(p - foot) > tolerance) return;
    if (norm(p - a) > 2 * tolerance && norm(p - b) > 2 * tolerance) found.push_back({t, point});
  });
  std::ranges::sort(found, {}, &OnEdge::t);
  return found;
}

/// Whether the points lead from one end of the edge to the other, along edges of the surface: the
/// other face was split there and this one was not.
bool is_chain(const PointGraph& graph, const PointGraph::Edge& edge,
              std::span<const OnEdge> inside) {
  Index from = edge.a;
  for (const OnEdge& next : inside) {
    if (!graph.has_edge(from, next.point)) return false;
    from = next.point;
  }
  return graph.has_edge(from, edge.b);
}

/// Lips of a tear may be split apart from each other: all three are points of the tear.
bool is_lip(const Skinned& skin, const PointGraph::Edge& edge, Index point) {
  const auto side = [&](Index of) {
    return skin.surface.tear_side[skin.graph.vertex_of_point[of]];
  };
  return side(point) != 0.0f && side(edge.a) != 0.0f && side(edge.b) != 0.0f;
}

}  // namespace

std::vector<Crack> find_unequal_copies(const Skinned& skin) {
  std::vector<Crack> cracks;
  PositionTable table(skin.surface.positions.size());
  const auto& meshes = skin.character.meshes;
  for (Index v = 0; v < skin.surface.vertex_count(); ++v) {
    if (skin.surface.triangle_of_vertex[v] == kNone) continue;
    const std::pair<Index, Index> here = in_mesh(skin.surface, v);
    bool is_known = false;
    table.find(skin.surface.positions[v], [&](Index other) {
      const std::pair<Index, Index> there = in_mesh(skin.surface, other);
      if (meshes[there.first].skin != meshes[here.first].skin) return false;
      is_known = true;
      if (!same_weights(skin.influences(here.first, here.second),
                        skin.influences(there.first, there.second)))
        cracks.push_back({v, {other, other}, 0.0});
      return true;
    });
    if (!is_known) table.insert(skin.surface.positions[v], v);
  }
  return cracks;
}

std::vector<Crack> find_t_junctions(const Skinned& skin) {
  const std::vector<PointGraph::Edge> borders = border_edges(skin.graph);
  const BorderGrid grid = make_grid(skin, borders);
  std::vector<Crack> cracks;
  for (const auto& edge : borders) {
    const std::vector<OnEdge> inside = points_on(skin, grid, edge);
    if (inside.empty() || !is_chain(skin.graph, edge, inside)) continue;
    for (const OnEdge& of : inside)
      if (!is_lip(skin, edge, of.point))
        cracks.push_back({skin.graph.vertex_of_point[of.point],
                          {skin.graph.vertex_of_point[edge.a], skin.graph.vertex_of_point[edge.b]},
                          of.t});
  }
  return cracks;
}

SkinDifferences rows_of_cracks(const RowReader& reader, const SkinPoints& points,
                               std::span<const Crack> cracks) {
  const BindSurface& surface = reader.target().surface;
  SkinDifferences rows;
  TermSum sum = points.make_sum();
  for (const Crack& crack : cracks) {
    const auto [mesh, vertex] = in_mesh(surface, crack.vertex);
    points.add_target(mesh, vertex, 1.0, sum);
    for (std::size_t end = 0; end < 2; ++end) {
      const double part = end == 0 ? 1.0 - crack.t : crack.t;
      const auto [of, at] = in_mesh(surface, crack.ends[end]);
      if (part > 0.0) points.add_target(of, at, -part, sum);
    }
    sum.finish(rows);
  }
  return rows;
}

namespace {

Places places_of(const Skinned& skin, std::span<const Crack> cracks) {
  Places places;
  for (const Crack& crack : cracks) places.push_back(skin.place(crack.vertex, kNone, 0.0));
  return places;
}

/// A kind of crack and the search for it.
struct CrackKind {
  Code code;
  std::vector<Crack> (*find)(const Skinned&);
};

/// The points and poses by which cracks are posed.
struct Posing {
  const SkinPoints& points;
  std::span<const PoseBatch> batches;
};

void check_kind(const RowReader& reader, const Posing& posing, const CrackKind& kind,
                CrackRows& all, FindingList& findings) {
  const auto [code, find] = kind;
  const std::vector<Crack> cracks = find(reader.target());
  if (cracks.empty()) return findings.add(code, {});
  const SkinDifferences rows = rows_of_cracks(reader, posing.points, cracks);
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    const auto terms = terms_of(rows, i);
    all.vertices.push_back(cracks[i].vertex);
    all.rows.terms.insert(all.rows.terms.end(), terms.begin(), terms.end());
    all.rows.first.push_back(static_cast<Index>(all.rows.terms.size()));
  }
  std::vector<double> widths(cracks.size(), 0.0);
  for (const PoseBatch& batch : posing.batches) raise_largest(rows, batch, widths);
  const double least = kind_of(code).threshold * reader.source().rest_diagonal;
  Places places;
  for (std::size_t i = 0; i < cracks.size(); ++i)
    if (widths[i] >= least)
      places.push_back(reader.target().place(cracks[i].vertex, kNone, widths[i]));
  const Places inherited =
      take_inherited(reader, places, places_of(reader.source(), find(reader.source())));
  findings.add_new(code, std::move(places), inherited, {}, Evidence::sampled);
}

}  // namespace

CrackRows check_cracks(const RowReader& reader, const SkinPoints& points,
                       std::span<const PoseBatch> batches, FindingList& findings) {
  CrackRows all;
  check_kind(reader, {points, batches}, {Code::crack, find_unequal_copies}, all, findings);
  check_kind(reader, {points, batches}, {Code::t_junction, find_t_junctions}, all, findings);
  return all;
}

Places find_welded_lips(const Skinned& reference, const Skinned& target) {
  // Places, numbered by the first point there, so that the two lips of an edge have one number.
  PositionTable table(reference.surface.positions.size());
  const auto number_of = [&](const Skinned& skin, Index point, bool add) {
    const Vec3d& place = place_of(skin, point);
    Index number = kNone;
    table.find(place, [&](Index of) {
      number = of;
      return true;
    });
    if (number == kNone && add) table.insert(place, number = point);
    return number;
  };
  std::map<std::pair<Index, Index>, std::uint32_t> lips;
  for (const auto& edge : border_edges(reference.graph)) {
    const Index a = number_of(reference, edge.a, true), b = number_of(reference, edge.b, true);
    ++lips[std::minmax(a, b)];
  }
  std::erase_if(lips, [](const auto& lip) { return lip.second < 2; });
  Places places;
  if (lips.empty()) return places;
  for (const auto& edge : target.graph.edges) {
    if (edge.faces < 2) continue;
    const Index a = number_of(target, edge.a, false), b = number_of(target, edge.b, false);
    if (a == kNone || b == kNone) continue;
    if (!lips.contains(std::minmax(a, b))) continue;
    for (const Index point : {edge.a, edge.b})
      places.push_back(target.place(target.graph.vertex_of_point[point], kNone, 1.0));
  }
  std::ranges::sort(places, [](const FindingPlace& a, const FindingPlace& b) {
    return std::tie(a.mesh, a.vertex) < std::tie(b.mesh, b.vertex);
  });
  const auto are_same = [](const FindingPlace& a, const FindingPlace& b) {
    return a.mesh == b.mesh && a.vertex == b.vertex;
  };
  places.erase(std::unique(places.begin(), places.end(), are_same), places.end());
  return places;
}

}  // namespace sunder::validation
