#include "tear/bodies/open_edges.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace sunder::bodies {
namespace {

using Edge = std::array<std::uint32_t, 2>;

/// Places that were seen, and the vertex that was at each first.
class FirstAtPlace {
 public:
  FirstAtPlace(std::span<const Vec3d> positions, std::size_t most)
      : positions_(positions), slots_(std::bit_ceil(2 * most + 1), kNone) {}

  /// The first vertex at the place of this one.
  std::uint32_t of(std::uint32_t vertex) {
    const Vec3d& at = positions_[vertex];
    std::uint64_t hash = 0;
    for (int i = 0; i < 3; ++i)  // + 0.0: zeros of either sign are equal
      hash = (hash ^ std::bit_cast<std::uint64_t>(at[i] + 0.0)) * 0x9E3779B97F4A7C15u;
    for (std::size_t i = (hash >> 32) & (slots_.size() - 1);; i = (i + 1) & (slots_.size() - 1)) {
      if (slots_[i] == kNone) slots_[i] = vertex;
      if (positions_[slots_[i]] == at) return slots_[i];
    }
  }

 private:
  std::span<const Vec3d> positions_;
  std::vector<std::uint32_t> slots_;
};

/// The least vertex at the position of each used one.
std::vector<std::uint32_t> weld(std::span<const Vec3d> positions,
                                std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> first(positions.size(), kNone);
  std::size_t used = 0;
  for (const Triangle& triangle : triangles) {
    if (is_retired(triangle)) continue;
    for (const std::uint32_t vertex : triangle) {
      used += first[vertex] == kNone ? 1 : 0;
      first[vertex] = vertex;
    }
  }
  FirstAtPlace places(positions, used);
  for (std::uint32_t& vertex : first)
    if (vertex != kNone) vertex = places.of(vertex);
  return first;
}

/// Edges that are left when opposite ones cancel each other, ascending.
std::vector<Edge> unmatched(std::span<const Triangle> triangles,
                            const std::vector<std::uint32_t>& first) {
  struct Directed {
    std::uint32_t greater;  ///< Vertex.
    bool is_reversed;
  };
  // The edges are put in order by their lesser vertices, of which few have the same.
  std::vector<std::uint32_t> begin_of(first.size() + 1, 0);
  const auto for_each_edge = [&](const auto& visit) {
    for (const Triangle& triangle : triangles) {
      if (is_retired(triangle)) continue;
      const Triangle at = {first[triangle[0]], first[triangle[1]], first[triangle[2]]};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = at[k], b = at[k < 2 ? k + 1 : 0];
        if (a != b) visit(std::min(a, b), Directed{std::max(a, b), a > b});
      }
    }
  };
  for_each_edge([&](std::uint32_t lesser, const Directed&) { ++begin_of[lesser + 1]; });
  for (std::size_t v = 1; v < begin_of.size(); ++v) begin_of[v] += begin_of[v - 1];
  std::vector<Directed> all(begin_of.back());
  std::vector<std::uint32_t> end_of(begin_of.begin(), begin_of.end() - 1);
  // Most edges meet their opposite among the last few of their vertex; the others are sorted.
  constexpr std::uint32_t kLooked = 8;
  for_each_edge([&](std::uint32_t lesser, const Directed& edge) {
    std::uint32_t& end = end_of[lesser];
    const std::uint32_t from = end - std::min(end - begin_of[lesser], kLooked);
    for (std::uint32_t i = from; i < end; ++i)
      if (all[i].greater == edge.greater && all[i].is_reversed != edge.is_reversed) {
        all[i] = all[--end];
        return;
      }
    all[end++] = edge;
  });
  std::vector<Edge> left;
  for (std::uint32_t lesser = 0; lesser < first.size(); ++lesser) {
    std::size_t begin = begin_of[lesser];
    if (begin == end_of[lesser]) continue;
    std::sort(all.begin() + static_cast<std::ptrdiff_t>(begin),
              all.begin() + static_cast<std::ptrdiff_t>(end_of[lesser]),
              [](const Directed& a, const Directed& b) { return a.greater < b.greater; });
    for (std::size_t end = begin; begin < end_of[lesser]; begin = end) {
      std::ptrdiff_t forward = 0;
      for (; end < end_of[lesser] && all[end].greater == all[begin].greater; ++end)
        forward += all[end].is_reversed ? -1 : 1;
      const std::uint32_t greater = all[begin].greater;
      for (; forward > 0; --forward) left.push_back({lesser, greater});
      for (; forward < 0; ++forward) left.push_back({greater, lesser});
    }
  }
  return left;
}

}  // namespace

OpenEdges find_open_edges(std::span<const Vec3d> positions, std::span<const Triangle> triangles) {
  const std::vector<Edge> edges = unmatched(triangles, weld(positions, triangles));
  std::vector<std::uint32_t> parent(edges.empty() ? 0 : positions.size());
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto find = [&](std::uint32_t v) {
    for (; parent[v] != v; v = parent[v]) parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b] : edges) {
    const std::uint32_t of_a = find(a), of_b = find(b);
    parent[std::max(of_a, of_b)] = std::min(of_a, of_b);
  }
  OpenEdges open;
  std::vector<std::uint32_t> group(parent.size(), kNone);
  for (const Edge& edge : edges) {
    std::uint32_t& of = group[find(edge[0])];
    if (of == kNone) {
      of = static_cast<std::uint32_t>(open.groups.size());
      open.groups.emplace_back();
    }
    open.groups[of].push_back(edge);
  }
  return open;
}

}  // namespace sunder::bodies
