#include "particles/motion/elimination_order.h"

#include <algorithm>
#include <numeric>

namespace sunder::particles {
namespace {

/// Parts of at most so many nodes are not divided: their factor is small and dense.
constexpr Index kMostUndivided = 12;

}  // namespace

void EliminationOrder::walk(const Graph& graph, Index from, Index mark, Index new_mark) {
  level_ends_.clear();
  Index next = walked_count_, end = next;
  walked_[end++] = from;
  marks_[from] = new_mark;
  while (next < end) {
    level_ends_.push_back(end);
    for (const Index level_end = end; next < level_end; ++next)
      for (const Index other : graph.of(walked_[next])) {
        // Without a branch, which no processor predicts.
        const Index found = marks_[other];
        const bool is_new = found == mark;
        marks_[other] = is_new ? new_mark : found;
        walked_[end] = other;
        end += is_new ? 1 : 0;
      }
  }
  walked_count_ = end;
}

/// The smallest of the levels that leave a quarter of the part on both sides; if none does, the one
/// that contains the middle.
std::size_t EliminationOrder::separating_level() const {
  const Index count = level_ends_.back(), quarter = count / 4;
  std::size_t best = 0;
  Index least = count;
  for (std::size_t level = 1; level + 1 < level_ends_.size(); ++level) {
    const Index begin = level_ends_[level - 1], end = level_ends_[level];
    if (begin < quarter || count - end < quarter || end - begin >= least) continue;
    least = end - begin;
    best = level;
  }
  if (best > 0) return best;
  const auto middle = std::upper_bound(level_ends_.begin(), level_ends_.end(), count / 2);
  return std::clamp(static_cast<std::size_t>(middle - level_ends_.begin()), std::size_t{1},
                    level_ends_.size() - 2);
}

void EliminationOrder::divide_at(std::size_t level, const Graph& graph, const Part& part) {
  const Index begin = level_ends_[level - 1], end = level_ends_[level];
  const Index beyond = ++last_mark_;
  for (Index i = end; i < walked_count_; ++i) marks_[walked_[i]] = beyond;
  // Nodes of the level that touch nothing beyond it do not separate.
  const auto separates = [&](Index node) {
    const auto others = graph.of(node);
    return std::any_of(others.begin(), others.end(),
                       [&](Index other) { return marks_[other] == beyond; });
  };
  std::copy_n(walked_.begin(), begin, nodes_.begin() + part.begin);
  Index near_end = part.begin + begin, beyond_end = part.end;
  for (Index i = begin; i < end; ++i) {
    const Index node = walked_[i];
    if (separates(node)) {
      nodes_[--beyond_end] = node;
      marks_[node] = 0;
    } else {
      nodes_[near_end++] = node;
    }
  }
  std::copy_n(walked_.begin() + end, beyond_end - near_end, nodes_.begin() + near_end);
  parts_.push_back({beyond_end, part.end});
  parts_.push_back({near_end, beyond_end, beyond});
  parts_.push_back({part.begin, near_end, part.mark});
}

/// @param mark  of the first component, which was walked over.
void EliminationOrder::divide_into_components(const Graph& graph, const Part& part, Index mark) {
  const auto first = static_cast<std::ptrdiff_t>(parts_.size());
  parts_.push_back({part.begin, part.begin + walked_count_, mark});
  for (Index place = part.begin; place < part.end; ++place) {
    if (marks_[nodes_[place]] != part.mark) continue;
    const Index begin = part.begin + walked_count_;
    walk(graph, nodes_[place], part.mark, mark);
    parts_.push_back({begin, part.begin + walked_count_, mark});
  }
  std::reverse(parts_.begin() + first, parts_.end());
  std::copy_n(walked_.begin(), walked_count_, nodes_.begin() + part.begin);
}

void EliminationOrder::divide(const Graph& graph, Part part) {
  const Index count = part.end - part.begin;
  if (part.mark != 0 && count > kMostUndivided) {
    const Index mark = ++last_mark_;
    walked_count_ = 0;
    walk(graph, nodes_[part.begin], part.mark, mark);
    if (walked_count_ < count) {
      divide_into_components(graph, part, mark);
      return;
    }
    // The last node is far from the first one, so levels around it are narrow.
    part.mark = ++last_mark_;
    walked_count_ = 0;
    walk(graph, walked_[count - 1], mark, part.mark);
    if (level_ends_.size() > 2) {
      divide_at(separating_level(), graph, part);
      return;
    }
  }
  group_ends_.push_back(part.end);
}

void EliminationOrder::dissect(std::span<const Index> first, std::span<const Index> others) {
  const auto count = static_cast<Index>(first.size() - 1);
  nodes_.resize(count);
  std::iota(nodes_.begin(), nodes_.end(), Index{0});
  walked_.resize(count + std::size_t{1});  // walk() writes one beyond the end
  last_mark_ = 1;
  marks_.assign(count, last_mark_);
  group_ends_.clear();
  parts_.clear();
  if (count > 0) parts_.push_back({0, count, last_mark_});
  while (!parts_.empty()) {
    const Part part = parts_.back();
    parts_.pop_back();
    divide({first, others}, part);
  }
  places_.resize(count);
  for (Index place = 0; place < count; ++place) places_[nodes_[place]] = place;
}

std::size_t EliminationOrder::memory_bytes() const {
  std::size_t bytes = parts_.capacity() * sizeof(Part);
  for (const auto* list : {&nodes_, &places_, &group_ends_, &marks_, &walked_, &level_ends_})
    bytes += list->capacity() * sizeof(Index);
  return bytes;
}

}  // namespace sunder::particles
