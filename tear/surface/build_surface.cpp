#include <algorithm>
#include <array>
#include <bit>
#include <string_view>

#include "core/internal/prefetch.h"
#include "tear/internal/surface.h"
#include "tear/surface/cracks.h"
#include "tear/surface/joined_meshes.h"

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
struct JoinedVertices {
  std::vector<std::vector<Index>> point_of_vertex;
  std::vector<Index> point_side;
  std::vector<bool> is_shared;  ///< Per point: it has vertices of two meshes.
};

/// A hash table of points by open addressing. An entry holds a point, and above it 32 bits of its
/// hash, so that nearly all other points are told apart without a look at their vertices.
class PointTable {
 public:
  explicit PointTable(std::size_t vertex_count)
      : mask_(std::bit_ceil(2 * vertex_count + 1) - 1), entries_(mask_ + 1, kEmpty) {}

  void prefetch(std::uint64_t hash) const { sunder::prefetch(&entries_[hash & mask_]); }

  /// The point of this hash for which is_same(point) holds; otherwise `new_point`, which is added.
  template <class IsSame>
  Index find_or_add(std::uint64_t hash, Index new_point, const IsSame& is_same) {
    const std::uint64_t high = hash & ~std::uint64_t{kNone};
    std::size_t slot = hash & mask_;
    for (; entries_[slot] != kEmpty; slot = (slot + 1) & mask_) {
      const auto point = static_cast<Index>(entries_[slot]);
      if ((entries_[slot] & ~std::uint64_t{kNone}) == high && is_same(point)) return point;
    }
    entries_[slot] = high | new_point;
    return new_point;
  }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};  // No point is kNone.

  std::size_t mask_;
  std::vector<std::uint64_t> entries_;
};

JoinedVertices weld_vertices(const Character& character) {
  struct VertexRef {
    Index mesh;
    Index vertex;
  };
  std::size_t vertex_count = 0;
  for (const Mesh& mesh : character.meshes) vertex_count += mesh.vertex_count();
  PointTable table(vertex_count);
  std::vector<VertexRef> first_of_point;

  const PointIdentity identity(character);
  JoinedVertices weld;
  const auto add = [&](Index m, Index v, std::uint64_t hash) {
    const auto new_point = static_cast<Index>(first_of_point.size());
    const Index point = table.find_or_add(hash, new_point, [&](Index known) {
      return identity.same(first_of_point[known].mesh, first_of_point[known].vertex, m, v);
    });
    if (point == new_point) {
      first_of_point.push_back({m, v});
      weld.point_side.push_back(identity.tear_side(m, v));
      weld.is_shared.push_back(false);
    }
    if (first_of_point[point].mesh != m) weld.is_shared[point] = true;
    weld.point_of_vertex[m].push_back(point);
  };
  constexpr Index kBlock = 32;  // of vertices whose entries are fetched side by side
  std::array<std::uint64_t, kBlock> hashes{};
  for (Index m = 0; m < character.meshes.size(); ++m) {
    const Index count = character.meshes[m].vertex_count();
    weld.point_of_vertex.emplace_back().reserve(count);
    for (Index begin = 0; begin < count; begin += kBlock) {
      const Index size = std::min(kBlock, count - begin);
      for (Index i = 0; i < size; ++i) {
        hashes[i] = identity.hash(m, begin + i);
        table.prefetch(hashes[i]);
      }
      for (Index i = 0; i < size; ++i) add(m, begin + i, hashes[i]);
    }
  }
  return weld;
}

/// Half-edges grouped by the smaller of their two points: a counting sort, so that pairing is
/// linear.
class HalfEdgeGroups {
 public:
  explicit HalfEdgeGroups(const Surface& surface) : first_(surface.point_corner.size() + 1, 0) {
    for_each_half_edge(surface, [&](Index, Index a, Index b) { ++first_[std::min(a, b) + 1]; });
    for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
    half_edges_.resize(first_.back());
    std::vector<Index> end(first_.begin(), first_.end() - 1);
    for_each_half_edge(surface, [&](Index h, Index a, Index b) {
      half_edges_[end[std::min(a, b)]++] = std::uint64_t{std::max(a, b)} << 32 | h;
    });
    for (std::size_t p = 0; p + 1 < first_.size(); ++p) sort(first_[p], first_[p + 1]);
  }

  /// Calls visit(half-edges of one edge) for every edge.
  template <class Visit>
  void for_each_edge(Visit visit) const {
    std::vector<Index> edge;
    for (std::size_t p = 0; p + 1 < first_.size(); ++p)
      for (Index i = first_[p]; i < first_[p + 1];) {
        const std::uint64_t larger = half_edges_[i] >> 32;
        edge.clear();
        for (; i < first_[p + 1] && half_edges_[i] >> 32 == larger; ++i)
          edge.push_back(static_cast<Index>(half_edges_[i]));
        visit(std::span<const Index>(edge));
      }
  }

 private:
  /// Calls visit(half-edge, its point, the next point), except for triangles with a repeated point.
  template <class Visit>
  static void for_each_half_edge(const Surface& surface, Visit visit) {
    const Index count = 3 * surface.triangle_count();
    for (Index h = 0; h < count; h += 3) {
      if (surface.has_repeated_point(h / 3)) continue;
      const Index a = surface.corner_point[h], b = surface.corner_point[h + 1],
                  c = surface.corner_point[h + 2];
      visit(h, a, b);
      visit(h + 1, b, c);
      visit(h + 2, c, a);
    }
  }

  void sort(Index begin, Index end) {
    constexpr Index kFew = 24;
    if (end - begin > kFew) {
      std::sort(half_edges_.begin() + begin, half_edges_.begin() + end);
      return;
    }
    for (Index i = begin + 1; i < end; ++i) {
      const std::uint64_t inserted = half_edges_[i];
      Index at = i;
      for (; at > begin && half_edges_[at - 1] > inserted; --at)
        half_edges_[at] = half_edges_[at - 1];
      half_edges_[at] = inserted;
    }
  }

  std::vector<Index> first_;  ///< Per point: index of its first entry in half_edges_.
  /// The larger point, and the half-edge in the lower 32 bits.
  std::vector<std::uint64_t> half_edges_;
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
  HalfEdgeGroups(surface).for_each_edge([&](std::span<const Index> edge) {
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

/// Calls visit(mesh, corner, vertex, whether its triangle is retired) for each corner.
template <class Visit>
void for_each_corner(const Character& character, Visit visit) {
  Index corner = 0;
  for (Index m = 0; m < character.meshes.size(); ++m)
    for (const Triangle& triangle : character.meshes[m].triangles)
      for (const Index vertex : triangle) visit(m, corner++, vertex, is_retired(triangle));
}

/// The surface of each mesh as if it were alone, around the points that meshes share. Triangles
/// elsewhere have a repeated point here, so that they join nothing.
Surface surface_at_shared_points(const Character& character, const JoinedVertices& weld) {
  Surface surface;
  surface.source_side = weld.point_side;
  surface.first_triangle = {0};
  for (const Mesh& mesh : character.meshes)
    surface.first_triangle.push_back(surface.first_triangle.back() + mesh.triangle_count());
  // Each mesh gets points of its own in place of those that it shares.
  std::vector<Index> own_of_shared(weld.point_side.size(), kNone), replaced;
  for (Index m = 0; m < character.meshes.size(); ++m) {
    for (const Triangle& triangle : character.meshes[m].triangles) {
      std::array<Index, 3> points{};
      bool is_near = false;
      for (std::size_t i = 0; i < 3; ++i) {
        points[i] = weld.point_of_vertex[m][triangle[i]];
        if (!weld.is_shared[points[i]]) continue;
        is_near = true;
        Index& own = own_of_shared[points[i]];
        if (own == kNone) {
          replaced.push_back(points[i]);
          own = static_cast<Index>(surface.source_side.size());
          surface.source_side.push_back(0);
        }
        points[i] = own;
      }
      if (!is_near) points = {0, 0, 0};
      surface.corner_point.insert(surface.corner_point.end(), points.begin(), points.end());
    }
    for (const Index point : replaced) own_of_shared[point] = kNone;
    replaced.clear();
  }
  surface.point_corner.assign(surface.source_side.size(), kNone);
  surface.twin.assign(surface.corner_point.size(), kNone);
  join_across_edges(character, surface);
  split_points_into_fans(surface);
  return surface;
}

/// @param surface  of all meshes together.
std::vector<Index> count_points_of_meshes(const Character& character, const JoinedVertices& weld,
                                          const Surface& surface) {
  std::vector<Index> counts(character.meshes.size(), 0);
  const bool do_share =
      std::find(weld.is_shared.begin(), weld.is_shared.end(), true) != weld.is_shared.end();
  const Surface alone = do_share ? surface_at_shared_points(character, weld) : Surface();
  std::vector<bool> is_counted(surface.point_corner.size(), false),
      is_counted_alone(alone.point_corner.size(), false);
  for_each_corner(character, [&](Index m, Index corner, Index vertex, bool is_in_retired) {
    if (is_in_retired) return;
    const bool is_shared = weld.is_shared[weld.point_of_vertex[m][vertex]];
    std::vector<bool>& counted = is_shared ? is_counted_alone : is_counted;
    const Index point = (is_shared ? alone : surface).corner_point[corner];
    counts[m] += counted[point] ? 0 : 1;
    counted[point] = true;
  });
  return counts;
}

void mark_shared_vertices(const Character& character, Surface& surface) {
  for (const Mesh& mesh : character.meshes)
    surface.is_shared_vertex.emplace_back(mesh.vertex_count(), false);
  std::vector<std::vector<Index>> point_of_vertex;
  for (const Mesh& mesh : character.meshes)
    point_of_vertex.emplace_back(mesh.vertex_count(), kNone);
  for_each_corner(character, [&](Index m, Index corner, Index vertex, bool) {
    Index& point = point_of_vertex[m][vertex];
    if (point == kNone) point = surface.corner_point[corner];
    // A degenerate triangle belongs to no fan: its vertices stay where they are when a fan moves
    // on.
    if (point != surface.corner_point[corner] || surface.has_repeated_point(corner / 3))
      surface.is_shared_vertex[m][vertex] = true;
  });
}

/// Corners, twins and points; not which vertices are shared.
/// @param point_side  of `weld`.
Surface connect(const Character& character, const JoinedVertices& weld,
                std::vector<Index> point_side) {
  Surface surface;
  surface.source_side = std::move(point_side);
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
  return surface;
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
  JoinedVertices weld = weld_vertices(character);
  Surface surface = connect(character, weld, std::move(weld.point_side));
  mark_shared_vertices(character, surface);
  if (std::all_of(surface.source_side.begin(), surface.source_side.end(),
                  [](Index side) { return side == 0; }))
    surface.source_side = {};
  surface.point_corner.shrink_to_fit();
  for (const Mesh& mesh : character.meshes) {
    float& largest = surface.largest_coordinate.emplace_back(0.0f);
    for (const Vec3f& position : mesh.positions)
      largest = std::max(largest, position.cwiseAbs().maxCoeff());
  }
  surface.cracks = find_cracks(character, surface);
  return surface;
}

JoinedMeshes join_meshes(const Character& character) {
  const JoinedVertices weld = weld_vertices(character);
  JoinedMeshes joined{connect(character, weld, weld.point_side), {}};
  joined.points_of_mesh = count_points_of_meshes(character, weld, joined.surface);
  return joined;
}

}  // namespace sunder::tear
