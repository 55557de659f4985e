#include "bodies/open_edges.h"

#include <algorithm>

namespace sunder::bodies {
namespace {

using Edge = std::array<std::uint32_t, 2>;

/// The least vertex at the position of each used one.
std::vector<std::uint32_t> weld(std::span<const Vec3d> positions,
                                std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> used;
  std::vector<bool> is_used(positions.size(), false);
  for (const Triangle& triangle : triangles) {
    if (is_retired(triangle)) continue;
    for (const std::uint32_t vertex : triangle) {
      if (!is_used[vertex]) used.push_back(vertex);
      is_used[vertex] = true;
    }
  }
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
    for (int i = 0; i < 3; ++i)
      if (positions[a][i] != positions[b][i]) return positions[a][i] < positions[b][i];
    return a < b;
  };
  std::sort(used.begin(), used.end(), is_before);
  std::vector<std::uint32_t> first(positions.size(), kNone);
  for (std::size_t i = 0; i < used.size(); ++i)
    first[used[i]] =
        i > 0 && positions[used[i]] == positions[used[i - 1]] ? first[used[i - 1]] : used[i];
  return first;
}

/// Edges that are left when opposite ones cancel each other, ascending.
std::vector<Edge> unmatched(std::span<const Triangle> triangles,
                            const std::vector<std::uint32_t>& first) {
  struct Directed {
    Edge edge;  ///< The lesser vertex first.
    bool is_reversed;
  };
  std::vector<Directed> all;
  for (const Triangle& triangle : triangles) {
    if (is_retired(triangle)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = first[triangle[k]], b = first[triangle[(k + 1) % 3]];
      if (a != b) all.push_back({{std::min(a, b), std::max(a, b)}, a > b});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Directed& a, const Directed& b) { return a.edge < b.edge; });
  std::vector<Edge> left;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    std::ptrdiff_t forward = 0;
    for (; end < all.size() && all[end].edge == all[begin].edge; ++end)
      forward += all[end].is_reversed ? -1 : 1;
    const auto [a, b] = all[begin].edge;
    for (; forward > 0; --forward) left.push_back({a, b});
    for (; forward < 0; ++forward) left.push_back({b, a});
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
