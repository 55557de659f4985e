#include "tear/surface/surface_cells.h"

#include <algorithm>
#include <utility>

namespace sunder::tear {
namespace {

/// Lists of numbers, one after the other.
struct Lists {
  std::vector<Index> values, first = {0};

  [[nodiscard]] Index count() const { return static_cast<Index>(first.size()) - 1; }
  [[nodiscard]] std::span<const Index> of(Index i) const {
    return std::span(values).subspan(first[i], first[i + 1] - first[i]);
  }
  void end_list() { first.push_back(static_cast<Index>(values.size())); }
};

/// Divides a graph into connected clusters of about `usual` nodes, at most `most`.
template <class ForEachNeighbour>
class Clustering {
 public:
  Clustering(Index count, Index usual, Index most, ForEachNeighbour for_each_neighbour)
      : cluster_of_(count, kNone),
        usual_(usual),
        most_(most),
        for_each_neighbour_(for_each_neighbour) {
    grow_all();
    merge_small();
  }

  /// The nodes of each cluster.
  [[nodiscard]] Lists lists() {
    Lists result;
    std::vector<Index> number(sizes_.size(), kNone), next;
    for (Index cluster = 0; cluster < sizes_.size(); ++cluster) {
      if (into_[cluster] != cluster) continue;
      number[cluster] = result.count();
      next.push_back(result.first.back());
      result.first.push_back(result.first.back() + sizes_[cluster]);
    }
    result.values.resize(cluster_of_.size());
    for (Index node = 0; node < cluster_of_.size(); ++node) {
      Index& cluster = cluster_of_[node];
      cluster = number[into_[cluster]];
      result.values[next[cluster]++] = node;
    }
    return result;
  }
  /// Per node. To be called after lists().
  [[nodiscard]] std::vector<Index> take_cluster_of() { return std::move(cluster_of_); }

 private:
  /// Clusters grow one next to the other, so that few nodes are left over between them.
  void grow_all() {
    std::vector<Index> frontier;
    std::size_t next = 0;
    for (Index node = 0; node < cluster_of_.size(); ++node) {
      if (cluster_of_[node] != kNone) continue;
      grow(node, frontier);
      for (; next < frontier.size(); ++next)
        if (cluster_of_[frontier[next]] == kNone) grow(frontier[next], frontier);
      frontier.clear();
      next = 0;
    }
  }

  void grow(Index seed, std::vector<Index>& frontier) {
    const auto cluster = static_cast<Index>(sizes_.size());
    members_.assign(1, seed);
    cluster_of_[seed] = cluster;
    for (std::size_t i = 0; i < members_.size(); ++i)
      for_each_neighbour_(members_[i], [&](Index other) {
        if (cluster_of_[other] != kNone) return;
        if (members_.size() == usual_) {
          frontier.push_back(other);
          return;
        }
        cluster_of_[other] = cluster;
        members_.push_back(other);
      });
    sizes_.push_back(static_cast<Index>(members_.size()));
  }

  /// Small clusters join their smallest neighbour that has room.
  void merge_small() {
    into_.resize(sizes_.size());
    for (Index i = 0; i < into_.size(); ++i) into_[i] = i;
    std::vector<Index> best(sizes_.size(), kNone);
    const auto root = [&](Index i) {
      while (into_[i] != i) i = into_[i];
      return i;
    };
    for (Index node = 0; node < cluster_of_.size(); ++node) {
      const Index cluster = cluster_of_[node];
      if (4 * sizes_[cluster] >= usual_) continue;
      for_each_neighbour_(node, [&](Index other) {
        const Index there = cluster_of_[other];
        if (there != cluster && (best[cluster] == kNone || sizes_[there] < sizes_[best[cluster]] ||
                                 (sizes_[there] == sizes_[best[cluster]] && there < best[cluster])))
          best[cluster] = there;
      });
    }
    for (Index cluster = 0; cluster < into_.size(); ++cluster) {
      if (best[cluster] == kNone) continue;
      const Index a = root(cluster), b = root(best[cluster]);
      if (a == b || sizes_[a] + sizes_[b] > most_) continue;
      into_[a] = b;
      sizes_[b] += sizes_[a];
    }
    for (Index& i : into_) i = root(i);
  }

  std::vector<Index> cluster_of_;  ///< Per node.
  std::vector<Index> sizes_, into_, members_;
  Index usual_, most_;
  ForEachNeighbour for_each_neighbour_;
};

/// The clusters next to each cluster. @param for_each_neighbour  of a node.
template <class ForEachNeighbour>
Lists contract(const Lists& clusters, std::span<const Index> cluster_of,
               ForEachNeighbour for_each_neighbour) {
  Lists neighbours;
  std::vector<Index> seen(clusters.count(), kNone);
  for (Index cluster = 0; cluster < clusters.count(); ++cluster) {
    seen[cluster] = cluster;
    for (const Index node : clusters.of(cluster))
      for_each_neighbour(node, [&](Index other) {
        const Index there = cluster_of[other];
        if (std::exchange(seen[there], cluster) != cluster) neighbours.values.push_back(there);
      });
    neighbours.end_list();
  }
  return neighbours;
}

}  // namespace

/// Adds the levels one after the other.
class SurfaceCells::Builder {
 public:
  explicit Builder(SurfaceCells& cells) : cells_(cells) {}

  void add_cells(std::span<const Index> twin, std::span<const float> area) {
    constexpr Index kUsualFaces = 16;
    const auto for_each_neighbour = [&](Index face, auto visit) {
      for (const Index other : twin.subspan(3 * std::size_t{face}, 3))
        if (other != kNone) visit(other / 3);
    };
    Clustering clustering(static_cast<Index>(area.size()), kUsualFaces, kMostFaces,
                          for_each_neighbour);
    Lists clusters = clustering.lists();
    const std::vector<Index> cell_of = clustering.take_cluster_of();
    neighbours_ = contract(clusters, cell_of, for_each_neighbour);
    cells_.cell_count_ = clusters.count();
    cells_.rank_.resize(area.size());
    for (Index cell = 0; cell < clusters.count(); ++cell) {
      const std::span<const Index> faces = clusters.of(cell);
      double sum = 0;
      for (Index i = 0; i < faces.size(); ++i) {
        cells_.rank_[faces[i]] = kMostFaces * cell + i;
        sum += static_cast<double>(area[faces[i]]);
      }
      add_node(static_cast<Index>(faces.size()), sum);
    }
    cells_.faces_ = std::move(clusters.values);
    cells_.first_face_ = std::move(clusters.first);
    cells_.first_child_ = {0};
  }

  /// @return whether another level was needed.
  bool add_level() {
    append_neighbours();
    // Nodes without neighbours are topmost.
    std::vector<Index> nodes, number(neighbours_.count(), kNone);
    for (Index i = 0; i < neighbours_.count(); ++i) {
      if (neighbours_.of(i).empty()) continue;
      number[i] = static_cast<Index>(nodes.size());
      nodes.push_back(i);
    }
    if (nodes.empty()) return false;
    constexpr Index kUsualChildren = 8;
    const auto for_each_neighbour = [&](Index i, auto visit) {
      for (const Index other : neighbours_.of(nodes[i])) visit(number[other]);
    };
    Clustering clustering(static_cast<Index>(nodes.size()), kUsualChildren, kMostChildren,
                          for_each_neighbour);
    const Lists clusters = clustering.lists();
    const std::vector<Index> cluster_of = clustering.take_cluster_of();
    Lists contracted = contract(clusters, cluster_of, for_each_neighbour);
    const Index begin = first_of_level_;
    first_of_level_ = cells_.node_count();
    for (Index cluster = 0; cluster < clusters.count(); ++cluster) {
      Index face_count = 0;
      double area = 0;
      for (const Index i : clusters.of(cluster)) {
        const Index child = begin + nodes[i];
        cells_.parent_[child] = first_of_level_ + cluster;
        cells_.children_.push_back(child);
        face_count += cells_.face_counts_[child];
        area += cells_.area(child);
      }
      cells_.first_child_.push_back(static_cast<Index>(cells_.children_.size()));
      add_node(face_count, area);
    }
    neighbours_ = std::move(contracted);
    return true;
  }

 private:
  void add_node(Index face_count, double area) {
    cells_.parent_.push_back(kNone);
    cells_.face_counts_.push_back(face_count);
    cells_.area_.push_back(static_cast<float>(area));
  }

  /// Keeps the neighbours of the newest level.
  void append_neighbours() {
    std::vector<Index>& all = cells_.neighbours_;
    std::vector<Index>& first = cells_.first_neighbour_;
    if (first.empty()) first.push_back(0);
    for (Index i = 0; i < neighbours_.count(); ++i) {
      for (const Index other : neighbours_.of(i)) all.push_back(first_of_level_ + other);
      first.push_back(static_cast<Index>(all.size()));
    }
  }

  SurfaceCells& cells_;
  Lists neighbours_;          ///< Of the newest level, numbered from 0.
  Index first_of_level_ = 0;  ///< Its first node.
};

SurfaceCells::SurfaceCells(std::span<const Index> twin, std::span<const float> area) {
  Builder builder(*this);
  builder.add_cells(twin, area);
  while (builder.add_level()) {
  }
  for (auto* values : {&faces_, &first_face_, &children_, &first_child_, &neighbours_,
                       &first_neighbour_, &parent_, &face_counts_})
    values->shrink_to_fit();
  area_.shrink_to_fit();
}

std::size_t SurfaceCells::bytes() const {
  std::size_t bytes = area_.capacity() * sizeof(float);
  for (const auto* values : {&rank_, &faces_, &first_face_, &children_, &first_child_, &neighbours_,
                             &first_neighbour_, &parent_, &face_counts_})
    bytes += values->capacity() * sizeof(Index);
  return bytes;
}

}  // namespace sunder::tear
