#include "pipeline/validation/checks/skinned.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "skinning/internal/reference.h"

namespace sunder::validation {
namespace {

/// Calls visit(a, b) with a < b for each edge of each face.
template <class Visit>
void for_each_edge(const BindSurface& surface, const Visit& visit) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!surface.has_area[t]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = surface.weld.point_of_vertex[surface.triangles[t][k]],
                  b = surface.weld.point_of_vertex[surface.triangles[t][(k + 1) % 3]];
      if (a != b) visit(std::min(a, b), std::max(a, b));
    }
  }
}

/// Sorted by their first points, and within the few edges of a point by the second.
std::vector<PointGraph::Edge> collect_edges(const BindSurface& surface) {
  std::vector<Index> first(std::size_t{surface.weld.point_count} + 1, 0);
  for_each_edge(surface, [&](Index a, Index) { ++first[a + 1]; });
  for (std::size_t p = 1; p < first.size(); ++p) first[p] += first[p - 1];
  std::vector<Index> ends(first.back()), next(first.begin(), first.end() - 1);
  for_each_edge(surface, [&](Index a, Index b) { ends[next[a]++] = b; });
  std::vector<PointGraph::Edge> edges;
  edges.reserve(ends.size() / 2 + 1);
  for (Index a = 0; a < surface.weld.point_count; ++a) {
    const auto begin = ends.begin() + first[a], end = ends.begin() + first[a + 1];
    std::sort(begin, end);
    for (auto b = begin; b != end; ++b) {
      if (b != begin && *b == *(b - 1))
        ++edges.back().faces;
      else
        edges.push_back({a, *b, 1});
    }
  }
  return edges;
}

void join_neighbours(const BindSurface& surface, PointGraph& graph) {
  const Index count = surface.weld.point_count;
  graph.first.assign(std::size_t{count} + 1, 0);
  for (const auto& edge : graph.edges) {
    ++graph.first[edge.a + 1];
    ++graph.first[edge.b + 1];
  }
  for (Index p = 0; p < count; ++p) graph.first[p + 1] += graph.first[p];
  graph.neighbours.resize(graph.edges.size() * 2);
  graph.lengths.resize(graph.edges.size() * 2);
  std::vector<Index> next(graph.first.begin(), graph.first.end() - 1);
  for (const auto& edge : graph.edges) {
    const double length = norm(surface.positions[graph.vertex_of_point[edge.a]] -
                               surface.positions[graph.vertex_of_point[edge.b]]);
    for (const auto& [from, to] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
      graph.neighbours[next[from]] = to;
      graph.lengths[next[from]++] = static_cast<float>(length);
    }
  }
}

void number_shells(PointGraph& graph) {
  graph.shell_of_point.assign(graph.point_count(), kNone);
  std::vector<Index> open;
  for (Index start = 0; start < graph.point_count(); ++start) {
    if (graph.shell_of_point[start] != kNone) continue;
    graph.shell_of_point[start] = graph.shell_count;
    open.push_back(start);
    while (!open.empty()) {
      const Index point = open.back();
      open.pop_back();
      for (const Index next : graph.around(point)) {
        if (graph.shell_of_point[next] != kNone) continue;
        graph.shell_of_point[next] = graph.shell_count;
        open.push_back(next);
      }
    }
    ++graph.shell_count;
  }
}

}  // namespace

double PointGraph::mean_length(Index point) const {
  double sum = 0.0;
  const auto of_point = lengths_around(point);
  for (const float length : of_point) sum += static_cast<double>(length);
  return of_point.empty() ? 0.0 : sum / static_cast<double>(of_point.size());
}

bool PointGraph::has_edge(Index a, Index b) const {
  const auto of_a = around(a);
  return std::find(of_a.begin(), of_a.end(), b) != of_a.end();
}

PointGraph make_point_graph(const BindSurface& surface) {
  PointGraph graph;
  graph.vertex_of_point.assign(surface.weld.point_count, kNone);
  for (Index v = surface.vertex_count(); v-- > 0;)
    graph.vertex_of_point[surface.weld.point_of_vertex[v]] = v;
  graph.edges = collect_edges(surface);
  join_neighbours(surface, graph);
  number_shells(graph);
  return graph;
}

namespace {

double diagonal_at_rest(const Character& character) {
  const ModelPose rest = or_throw(rest_pose(character));
  Eigen::AlignedBox3d box;
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    std::vector<Affine3d> palette(skin.bones.size());
    if (!compute_palette(skin, rest, palette)) return 0.0;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      box.extend(Eigen::Vector3d(
          deform_position_reference(mesh, v, palette, character.rest_morph_weights)));
  }
  return box.isEmpty() ? 0.0 : norm(box.diagonal());
}

/// Bones that are scaled to nothing, and bones that no skin has, do not count.
double unit_at_rest(const Character& character) {
  const ModelPose bind = or_throw(bind_pose(character)), rest = or_throw(rest_pose(character));
  std::vector<bool> is_of_skin(character.skeleton.bones.size(), false);
  for (const Skin& skin : character.skins)
    for (const Index bone : skin.bones) is_of_skin[bone] = true;
  std::vector<double> lengths;
  for (Index bone = 0; bone < is_of_skin.size(); ++bone) {
    if (!is_of_skin[bone]) continue;
    const double volume = std::abs(determinant(rest.model_from_bone[bone].linear()) /
                                   determinant(bind.model_from_bone[bone].linear()));
    if (volume > 0.0 && std::isfinite(volume)) lengths.push_back(std::cbrt(volume));
  }
  if (lengths.empty()) return 1.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace

Skinned::Skinned(const Character& of, std::span<const StoredInfluences> stored_influences)
    : Skinned(of, stored_influences, or_throw(bind_pose(of))) {}

Skinned::Skinned(const Character& of, std::span<const StoredInfluences> stored_influences,
                 const ModelPose& pose)
    : character(of),
      stored(stored_influences),
      surface(make_bind_surface(of, pose)),
      graph(make_point_graph(surface)),
      rest_diagonal(diagonal_at_rest(of)),
      metres_per_bind_unit(unit_at_rest(of)) {
  if (!(rest_diagonal > 0.0) || !std::isfinite(rest_diagonal)) rest_diagonal = surface.diagonal;
}

}  // namespace sunder::validation
