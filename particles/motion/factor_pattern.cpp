#include "particles/motion/factor_pattern.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace sunder::particles {

void FactorPattern::find_springs(const SpringMatrix::Pattern& matrix) {
  const Index nodes = matrix.nodes();
  const auto for_each_spring = [&](auto visit) {
    for (Index node = 0; node < nodes; ++node)
      for (Index e = matrix.first[node]; e < matrix.first[node + 1]; ++e)
        if (matrix.columns[e] < nodes) visit(node, matrix.columns[e], e);
  };
  first_.assign(nodes + std::size_t{1}, 0);
  for_each_spring([&](Index a, Index b, Index) {
    ++first_[a];
    ++first_[b];
  });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  others_.resize(first_.back());
  entries_.resize(first_.back());
  // Each node's part is filled from its end, so first_ has its beginning afterwards.
  for_each_spring([&](Index a, Index b, Index entry) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      const Index at = --first_[from];
      others_[at] = to;
      entries_[at] = entry;
    }
  });
}

void FactorPattern::find_groups(const SpringMatrix::Pattern& matrix) {
  groups_.clear();
  group_of_.clear();
  const auto add = [&](Index end) {
    const auto begin = static_cast<Index>(group_of_.size());
    group_of_.resize(end, static_cast<Index>(groups_.size()));
    groups_.push_back({begin, end});
  };
  for (const Index end : order_.group_ends()) add(end);
  if (matrix.pulls > 0) add(matrix.nodes() + matrix.pulls);
}

void FactorPattern::find_border(const SpringMatrix::Pattern& matrix, Index g) {
  Group& group = groups_[g];
  group.first_border = static_cast<Index>(borders_.size());
  const Index nodes = matrix.nodes();
  Index last = group.end;
  const auto add = [&](Index place) {
    if (place < group.end) return;
    in_border_[place / 64] |= std::uint64_t{1} << (place % 64);
    last = std::max(last, place);
  };
  for (Index place = group.begin; place < std::min(group.end, nodes); ++place) {
    const Index node = order_.nodes()[place];
    for (Index s = first_[node]; s < first_[node + 1]; ++s) add(order_.places()[others_[s]]);
    for (Index e = matrix.first[node]; e < matrix.first[node + 1]; ++e)
      if (matrix.columns[e] >= nodes) add(matrix.columns[e]);
  }
  for (Index child = children_[g]; child != kNone; child = siblings_[child])
    for (Index b = groups_[child].first_border; b < groups_[child].border_end; ++b)
      add(borders_[b]);
  for (Index word = group.end / 64; word <= last / 64; ++word) {
    for (std::uint64_t bits = in_border_[word]; bits != 0; bits &= bits - 1)
      borders_.push_back(64 * word + static_cast<Index>(std::countr_zero(bits)));
    in_border_[word] = 0;
  }
  group.border_end = static_cast<Index>(borders_.size());
  const auto begin = borders_.begin() + group.first_border;
  group.pulls = static_cast<Index>(borders_.end() - std::lower_bound(begin, borders_.end(), nodes));
  if (group.border() == 0) return;
  const Index parent = group_of_[*begin];
  siblings_[g] = children_[parent];
  children_[parent] = g;
}

void FactorPattern::find_targets(Group& group) {
  group.first_target = static_cast<Index>(targets_.size());
  for (Index b = group.first_border; b < group.border_end;) {
    Target target;
    target.group = group_of_[borders_[b]];
    target.first = b - group.first_border;
    target.rows = static_cast<Index>(target_rows_.size());
    const Group& to = groups_[target.group];
    for (; b < group.border_end && borders_[b] < to.end; ++b)
      target_rows_.push_back(borders_[b] - to.begin);
    target.end = b - group.first_border;
    // The rest of the border is part of the target's one.
    Index at = to.first_border;
    for (Index rest = b; rest < group.border_end; ++rest) {
      while (borders_[at] != borders_[rest]) ++at;
      target_rows_.push_back(to.pivots() + at - to.first_border);
    }
    target_rows_.push_back(to.height() - 1);
    targets_.push_back(target);
  }
  group.target_end = static_cast<Index>(targets_.size());
}

void FactorPattern::find_slots(const SpringMatrix::Pattern& matrix) {
  const Index nodes = matrix.nodes();
  slots_.resize(matrix.columns.size());
  rows_.resize(group_of_.size());
  for (const Group& group : groups_) {
    for (Index place = group.begin; place < group.end; ++place) rows_[place] = place - group.begin;
    for (Index b = group.first_border; b < group.border_end; ++b)
      rows_[borders_[b]] = group.pivots() + b - group.first_border;
    for (Index place = group.begin; place < std::min(group.end, nodes); ++place) {
      const Index node = order_.nodes()[place];
      const std::size_t column = group.panel + std::size_t{place - group.begin} * group.height();
      for (Index s = first_[node]; s < first_[node + 1]; ++s) {
        const Index other = order_.places()[others_[s]];
        if (other > place) slots_[entries_[s]] = column + rows_[other];
      }
      for (Index e = matrix.first[node]; e < matrix.first[node + 1]; ++e)
        if (matrix.columns[e] >= nodes) slots_[e] = column + rows_[matrix.columns[e]];
    }
  }
}

void FactorPattern::analyse(const SpringMatrix::Pattern& matrix) {
  find_springs(matrix);
  order_.dissect(first_, others_);
  find_groups(matrix);
  borders_.clear();
  targets_.clear();
  target_rows_.clear();
  in_border_.assign(group_of_.size() / 64 + 1, 0);
  children_.assign(groups_.size(), kNone);
  siblings_.assign(groups_.size(), kNone);
  std::size_t panel = 0;
  for (Index g = 0; g < groups_.size(); ++g) {
    find_border(matrix, g);
    groups_[g].panel = panel;
    panel += std::size_t{groups_[g].pivots()} * groups_[g].height();
  }
  for (Group& group : groups_) find_targets(group);
  find_slots(matrix);
}

std::size_t FactorPattern::panel_entries() const {
  if (groups_.empty()) return 0;
  return groups_.back().panel + std::size_t{groups_.back().pivots()} * groups_.back().height();
}

std::size_t FactorPattern::tallest() const {
  std::size_t most = 0;
  for (const Group& group : groups_) most = std::max<std::size_t>(most, group.height());
  return most;
}

std::size_t FactorPattern::memory_bytes() const {
  std::size_t bytes = order_.memory_bytes() + groups_.capacity() * sizeof(Group) +
                      targets_.capacity() * sizeof(Target) +
                      slots_.capacity() * sizeof(std::size_t) +
                      in_border_.capacity() * sizeof(std::uint64_t);
  for (const auto* list : {&first_, &others_, &entries_, &group_of_, &borders_, &target_rows_,
                           &rows_, &children_, &siblings_})
    bytes += list->capacity() * sizeof(Index);
  return bytes;
}

}  // namespace sunder::particles
