#include "particles/motion/elimination_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using particles::EliminationOrder;

struct Graph {
  std::vector<Index> first = {0}, others;

  [[nodiscard]] Index nodes() const { return static_cast<Index>(first.size() - 1); }
  [[nodiscard]] std::span<const Index> of(Index node) const {
    return std::span(others).subspan(first[node], first[node + 1] - first[node]);
  }
};

Graph graph_of(Index nodes, const std::vector<std::pair<Index, Index>>& pairs) {
  std::vector<std::vector<Index>> others(nodes);
  for (const auto& [a, b] : pairs) {
    others[a].push_back(b);
    others[b].push_back(a);
  }
  Graph graph;
  for (const auto& of_one : others) {
    graph.others.insert(graph.others.end(), of_one.begin(), of_one.end());
    graph.first.push_back(static_cast<Index>(graph.others.size()));
  }
  return graph;
}

Graph grid(Index width) {
  std::vector<std::pair<Index, Index>> pairs;
  for (Index y = 0; y < width; ++y)
    for (Index x = 0; x < width; ++x) {
      if (x + 1 < width) pairs.emplace_back(y * width + x, y * width + x + 1);
      if (y + 1 < width) pairs.emplace_back(y * width + x, (y + 1) * width + x);
    }
  return graph_of(width * width, pairs);
}

void expect_order(const Graph& graph, const EliminationOrder& order) {
  std::vector<Index> all(graph.nodes());
  std::iota(all.begin(), all.end(), Index{0});
  std::vector<Index> nodes(order.nodes().begin(), order.nodes().end());
  std::sort(nodes.begin(), nodes.end());
  ASSERT_EQ(nodes, all);
  for (const Index p : all) ASSERT_EQ(order.nodes()[order.places()[p]], p);
  Index before = 0;
  for (const Index end : order.group_ends()) {
    ASSERT_LT(before, end);
    before = end;
  }
  ASSERT_EQ(before, all.size());
}

/// Entries of the factor below its diagonal, by elimination of one node after the other.
std::size_t entries(const Graph& graph, std::span<const Index> places) {
  std::vector<std::set<Index>> later(places.size());
  for (Index p = 0; p < places.size(); ++p)
    for (const Index other : graph.of(p))
      if (places[other] > places[p]) later[places[p]].insert(places[other]);
  std::size_t count = 0;
  for (std::set<Index>& of_one : later) {
    count += of_one.size();
    if (of_one.empty()) continue;
    const Index next = *of_one.begin();
    later[next].insert(std::next(of_one.begin()), of_one.end());
  }
  return count;
}

TEST(elimination_order, has_every_node_once) {
  test::Random random(1);
  EliminationOrder order;
  for (int trial = 0; trial < 300; ++trial) {
    const Index nodes = random.index(80);
    std::vector<std::pair<Index, Index>> pairs;
    for (Index i = nodes > 0 ? random.index(4 * nodes) : 0; i > 0; --i) {
      const Index a = random.index(nodes), b = random.index(nodes);
      if (a != b) pairs.emplace_back(a, b);
    }
    const Graph graph = graph_of(nodes, pairs);
    order.dissect(graph.first, graph.others);
    expect_order(graph, order);
    EliminationOrder again;
    again.dissect(graph.first, graph.others);
    ASSERT_TRUE(std::ranges::equal(order.nodes(), again.nodes()));
    ASSERT_TRUE(std::ranges::equal(order.group_ends(), again.group_ends()));
  }
}

TEST(elimination_order, keeps_the_factor_of_a_surface_sparse) {
  for (const Index width : {20u, 40u, 80u}) {
    const Graph graph = grid(width);
    EliminationOrder order;
    order.dissect(graph.first, graph.others);
    expect_order(graph, order);
    // Row by row there are `width` entries per node.
    EXPECT_LT(static_cast<double>(entries(graph, order.places())),
              3 * width * width * std::log2(width));
  }
}

TEST(elimination_order, handles_lines_stars_and_nodes_without_neighbours) {
  constexpr Index kCount = 100000;
  std::vector<std::pair<Index, Index>> line, star;
  for (Index p = 1; p < kCount; ++p) {
    line.emplace_back(p - 1, p);
    star.emplace_back(kCount / 2, p == kCount / 2 ? 0 : p);
  }
  EliminationOrder order;
  for (const auto& pairs : {line, star, {}}) {
    const Graph graph = graph_of(kCount, pairs);
    order.dissect(graph.first, graph.others);
    expect_order(graph, order);
    EXPECT_LT(entries(graph, order.places()), 4 * kCount);
  }
}

}  // namespace
}  // namespace sunder
