#pragma once

#include <sunder/core/index.h>

#include <span>
#include <vector>

namespace sunder::particles {

/// An order of the nodes of a graph in which the factor of a matrix on it stays sparse: nested
/// dissection (George, 1973). Nodes that separate two halves come after both halves, and each half
/// is divided in the same way. Separating nodes, and the nodes of a part that is too small to be
/// divided, are a group: they follow one another.
class EliminationOrder {
 public:
  ///
  /// @param first   per node its first neighbour in `others`; the total at the end.
  /// @param others  neighbours, from both ends. O(neighbours x log(nodes)); no allocation once
  ///                warm. @throws std::bad_alloc
  void dissect(std::span<const Index> first, std::span<const Index> others);

  /// All nodes, in the order.
  [[nodiscard]] std::span<const Index> nodes() const { return nodes_; }
  /// Per node its place in nodes().
  [[nodiscard]] std::span<const Index> places() const { return places_; }
  /// Per group the end of its nodes in nodes().
  [[nodiscard]] std::span<const Index> group_ends() const { return group_ends_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Graph {
    std::span<const Index> first, others;
    [[nodiscard]] std::span<const Index> of(Index node) const {
      return others.subspan(first[node], first[node + 1] - first[node]);
    }
  };
  /// Consecutive nodes of the order. No neighbour of theirs that is not of the part has its mark.
  struct Part {
    Index begin = 0, end = 0;
    Index mark = 0;  // 0: a group, not to be divided
  };

  void divide(const Graph& graph, Part part);
  void divide_into_components(const Graph& graph, const Part& part, Index mark);
  /// Divides a part whose nodes were walked over at one of the levels.
  void divide_at(std::size_t level, const Graph& graph, const Part& part);
  /// Appends the nodes with a mark that are connected with a node to `walked_`, in order of
  /// distance, and gives them a new mark. Writes `level_ends_`.
  void walk(const Graph& graph, Index from, Index mark, Index new_mark);
  [[nodiscard]] std::size_t separating_level() const;

  std::vector<Index> nodes_, places_, group_ends_;
  std::vector<Index> marks_;  // per node
  Index last_mark_ = 0;
  std::vector<Index> walked_;
  Index walked_count_ = 0;
  std::vector<Index> level_ends_;  // per distance the end of its nodes in walked_
  std::vector<Part> parts_;        // to be divided, the first one on top
};

}  // namespace sunder::particles
