#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

const CustomAttribute* find_tear_side(const Mesh& mesh) {
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    if (attribute.name == kTearSideAttribute && attribute.components == 1) return &attribute;
  return nullptr;
}

/// Decides which vertices are one surface point.
class PointIdentity {
 public:
  explicit PointIdentity(const Character& character) : character_(character) {
    for (const Mesh& mesh : character.meshes) tear_sides_.push_back(find_tear_side(mesh));
  }

  [[nodiscard]] Index tear_side(Index mesh, Index vertex) const {
    const CustomAttribute* sides = tear_sides_[mesh];
    if (sides == nullptr) return 0;
    const float side = sides->values[vertex];
    return side > 0.0f && side < 1e9f ? static_cast<Index>(side) : 0;
  }

  [[nodiscard]] std::uint64_t hash(Index mesh, Index vertex) const {
    const Mesh& of = character_.meshes[mesh];
    std::uint64_t h = 0x9E3779B97F4A7C15u ^ of.skin;
    for (int i = 0; i < 3; ++i) {
      const float coordinate =
          of.positions[vertex][i] +
          0.0f;  // -0 + 0 = +0: the two compare equal, so their hashes must agree
      h = (h ^ std::bit_cast<std::uint32_t>(coordinate)) * 0xFF51AFD7ED558CCDu;
      h ^= h >> 32;
    }
    return h;
  }

  [[nodiscard]] bool same(Index mesh_a, Index a, Index mesh_b, Index b) const {
    const Mesh& in_a = character_.meshes[mesh_a];
    const Mesh& in_b = character_.meshes[mesh_b];
    return in_a.positions[a] == in_b.positions[b] && in_a.skin == in_b.skin &&
           tear_side(mesh_a, a) == tear_side(mesh_b, b) &&
           same_weights(in_a.weights.of(a), in_b.weights.of(b)) && same_morphs(in_a, a, in_b, b);
  }

 private:
  static bool same_weights(std::span<const Influence> a, std::span<const Influence> b) {
    return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](const Influence& influence) {
             return std::find(b.begin(), b.end(), influence) != b.end();
           });
  }

  static bool same_morphs(const Mesh& mesh_a, Index a, const Mesh& mesh_b, Index b) {
    const auto displacement = [](const Mesh& mesh, std::size_t target, Index vertex) -> Vec3f {
      if (target >= mesh.morph_targets.size() || mesh.morph_targets[target].position_deltas.empty())
        return Vec3f::Zero();
      return mesh.morph_targets[target].position_deltas[vertex];
    };
    const bool same_weights_drive_both = mesh_a.first_morph_weight == mesh_b.first_morph_weight;
    const std::size_t count = std::max(mesh_a.morph_targets.size(), mesh_b.morph_targets.size());
    for (std::size_t target = 0; target < count; ++target) {
      const Vec3f of_a = displacement(mesh_a, target, a), of_b = displacement(mesh_b, target, b);
      if (of_a != of_b) return false;
      if (!same_weights_drive_both && !of_a.isZero(0.0f)) return false;
    }
    return true;
  }

  const Character& character_;
  std::vector<const CustomAttribute*> tear_sides_;
};

/// The point of every vertex of every mesh.
struct Weld {
  std::vector<std::vector<Index>> point_of_vertex;
  std::vector<Index> point_side;
};

Weld weld_vertices(const Character& character) {
  struct VertexRef {
    Index mesh;
    Index vertex;
  };
  std::size_t vertex_count = 0;
  for (const Mesh& mesh : character.meshes) vertex_count += mesh.vertex_count();
  const std::size_t table_size = std::bit_ceil(2 * vertex_count + 1);
  std::vector<Index> table(table_size, kNone);  // open addressing; holds points
  std::vector<VertexRef> first_of_point;

  const PointIdentity identity(character);
  Weld weld;
  for (Index m = 0; m < character.meshes.size(); ++m) {
    auto& points = weld.point_of_vertex.emplace_back();
    points.reserve(character.meshes[m].vertex_count());
    for (Index v = 0; v < character.meshes[m].vertex_count(); ++v) {
      std::size_t slot = identity.hash(m, v) & (table_size - 1);
      while (table[slot] != kNone && !identity.same(first_of_point[table[slot]].mesh,
                                                    first_of_point[table[slot]].vertex, m, v))
        slot = (slot + 1) & (table_size - 1);
      if (table[slot] == kNone) {
        table[slot] = static_cast<Index>(first_of_point.size());
        first_of_point.push_back({m, v});
        weld.point_side.push_back(identity.tear_side(m, v));
      }
      points.push_back(table[slot]);
    }
  }
  return weld;
}

/// Half-edges grouped by the smaller of their two points: a counting sort, so that pairing is
/// linear.
class HalfEdgeGroups {
 public:
  explicit HalfEdgeGroups(const Surface& surface) : first_(surface.point_corner.size() + 1, 0) {
    const auto& points = surface.corner_point;
    const auto smaller = [&](Index h) { return std::min(points[h], points[Surface::next(h)]); };
    const Index count = 3 * surface.triangle_count();
    for (Index h = 0; h < count; ++h)
      if (!surface.has_repeated_point(h / 3)) ++first_[smaller(h) + 1];
    for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
    half_edges_.resize(first_.back());
    std::vector<Index> end(first_.begin(), first_.end() - 1);
    for (Index h = 0; h < count; ++h)
      if (!surface.has_repeated_point(h / 3)) half_edges_[end[smaller(h)]++] = h;
    for (std::size_t p = 0; p + 1 < first_.size(); ++p)
      std::sort(half_edges_.begin() + first_[p], half_edges_.begin() + first_[p + 1],
                [&](Index a, Index b) {
                  const Index larger_a = std::max(points[a], points[Surface::next(a)]),
                              larger_b = std::max(points[b], points[Surface::next(b)]);
                  return larger_a != larger_b ? larger_a < larger_b : a < b;
                });
  }

  /// Calls visit(half-edges of one edge) for every edge.
  template <class Visit>
  void for_each_edge(const Surface& surface, Visit visit) const {
    const auto& points = surface.corner_point;
    const auto larger = [&](Index h) { return std::max(points[h], points[Surface::next(h)]); };
    for (std::size_t p = 0; p + 1 < first_.size(); ++p)
      for (Index begin = first_[p], end = begin; begin < first_[p + 1]; begin = end) {
        while (end < first_[p + 1] && larger(half_edges_[end]) == larger(half_edges_[begin])) ++end;
        visit(std::span<const Index>(half_edges_.data() + begin, end - begin));
      }
  }

 private:
  std::vector<Index> first_;  ///< Per point: index of its first entry in half_edges_.
  std::vector<Index> half_edges_;
};

/// The mesh and the vertices at both ends of a half-edge. They tell which of several faces at one
/// edge were modelled as neighbours.
std::array<Index, 3> edge_vertices(const Character& character, const Surface& surface, Index h,
                                   bool reversed) {
  const TriangleRef ref = surface.triangle(h / 3);
  const Triangle& triangle = character.meshes[ref.mesh].triangles[ref.triangle];
  const Index from = triangle[h % 3], to = triangle[Surface::next(h) % 3];
  return reversed ? std::array{ref.mesh, to, from} : std::array{ref.mesh, from, to};
}

void join_across_edges(const Character& character, Surface& surface) {
  const auto join = [&](Index a, Index b) {
    surface.twin[a] = b;
    surface.twin[b] = a;
  };
  HalfEdgeGroups(surface).for_each_edge(surface, [&](std::span<const Index> edge) {
    if (edge.size() < 2) return;
    if (edge.size() == 2 && surface.corner_point[edge[0]] != surface.corner_point[edge[1]]) {
      join(edge[0], edge[1]);
      return;
    }
    ++surface.non_manifold_edges;
    surface.non_manifold_half_edges += static_cast<Index>(edge.size());
    if (edge.size() > 64)
      return;  // a fan of that many faces on one edge is not a surface; the search below is
               // quadratic
    for (std::size_t i = 0; i < edge.size(); ++i) {
      Index partner = kNone;
      bool unique = surface.twin[edge[i]] == kNone;
      for (std::size_t j = 0; j < edge.size() && unique; ++j) {
        if (j == i || edge[i] / 3 == edge[j] / 3) continue;
        const bool opposite = edge_vertices(character, surface, edge[i], false) ==
                              edge_vertices(character, surface, edge[j], true);
        const bool rival = edge_vertices(character, surface, edge[i], false) ==
                           edge_vertices(character, surface, edge[j], false);
        unique = !rival && (!opposite || partner == kNone);
        if (opposite) partner = edge[j];
      }
      if (unique && partner != kNone && surface.twin[partner] == kNone) {
        join(edge[i], partner);
        surface.non_manifold_half_edges -= 2;
      }
    }
  });
}

/// Gives each fan a point of its own, so that a point names one connected neighbourhood.
void split_points_into_fans(Surface& surface) {
  std::vector<bool> is_assigned(surface.corner_point.size(), false);
  for (Index corner = 0; corner < surface.corner_point.size(); ++corner) {
    if (is_assigned[corner] || surface.has_repeated_point(corner / 3)) continue;
    Index point = surface.corner_point[corner];
    if (surface.point_corner[point] != kNone) {
      surface.source_side.push_back(surface.source_side[point]);
      point = static_cast<Index>(surface.point_corner.size());
      surface.point_corner.push_back(kNone);
    }
    surface.point_corner[point] = corner;
    surface.for_each_in_fan(corner, [&](Index c) {
      surface.corner_point[c] = point;
      is_assigned[c] = true;
    });
  }
}

void mark_shared_vertices(const Character& character, Surface& surface) {
  for (const Mesh& mesh : character.meshes)
    surface.is_shared_vertex.emplace_back(mesh.vertex_count(), false);
  std::vector<std::vector<Index>> point_of_vertex;
  for (const Mesh& mesh : character.meshes)
    point_of_vertex.emplace_back(mesh.vertex_count(), kNone);
  for (Index corner = 0; corner < surface.corner_point.size(); ++corner) {
    const TriangleRef ref = surface.triangle(corner / 3);
    const Index vertex = character.meshes[ref.mesh].triangles[ref.triangle][corner % 3];
    Index& point = point_of_vertex[ref.mesh][vertex];
    if (point == kNone) point = surface.corner_point[corner];
    // A degenerate triangle belongs to no fan: its vertices stay where they are when a fan moves
    // on.
    if (point != surface.corner_point[corner] || surface.has_repeated_point(corner / 3))
      surface.is_shared_vertex[ref.mesh][vertex] = true;
  }
}

}  // namespace

Index Surface::find_half_edge(Index from, Index to) const {
  Index found = kNone;
  for_each_in_fan(point_corner[from], [&](Index corner) {
    if (corner_point[next(corner)] == to) found = corner;
  });
  return found;
}

Surface build_surface(const Character& character) {
  Weld weld = weld_vertices(character);
  Surface surface;
  surface.source_side = std::move(weld.point_side);
  surface.point_corner.assign(surface.source_side.size(), kNone);
  surface.first_triangle = {0};
  for (const Mesh& mesh : character.meshes)
    surface.first_triangle.push_back(surface.first_triangle.back() + mesh.triangle_count());
  surface.corner_point.reserve(3 * std::size_t{surface.first_triangle.back()});
  for (Index m = 0; m < character.meshes.size(); ++m)
    for (const Triangle& triangle : character.meshes[m].triangles)
      for (const Index vertex : triangle)
        surface.corner_point.push_back(weld.point_of_vertex[m][vertex]);
  surface.twin.assign(surface.corner_point.size(), kNone);
  join_across_edges(character, surface);
  split_points_into_fans(surface);
  mark_shared_vertices(character, surface);
  if (std::all_of(surface.source_side.begin(), surface.source_side.end(),
                  [](Index side) { return side == 0; }))
    surface.source_side = {};
  surface.point_corner.shrink_to_fit();
  return surface;
}

}  // namespace sunder::tear
