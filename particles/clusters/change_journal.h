#pragma once

#include <sunder/core/index.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder::particles {

/// The latest entries of a growing list, for readers that read it from time to time.
template <class Entry>
class Journal {
 public:
  void add(const Entry& entry) { entries_.push_back(entry); }
  void add(std::span<const Entry> entries) {
    entries_.insert(entries_.end(), entries.begin(), entries.end());
  }
  /// Number of entries ever added: the place from which a reader reads the next time.
  [[nodiscard]] std::uint64_t end() const { return first_ + entries_.size(); }
  /// Whether all entries from a place on are still there.
  [[nodiscard]] bool has_since(std::uint64_t place) const { return place >= first_; }
  [[nodiscard]] std::span<const Entry> since(std::uint64_t place) const {
    return std::span(entries_).subspan(static_cast<std::size_t>(place - first_));
  }
  /// Drops the older half if there are more entries than `most`: for a reader that missed so many,
  /// reading everything is faster.
  void trim(std::size_t most) {
    if (entries_.size() <= most) return;
    const std::size_t dropped = entries_.size() / 2;
    entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(dropped));
    first_ += dropped;
  }

 private:
  std::uint64_t first_ = 0;
  std::vector<Entry> entries_;
};

/// A vertex of a mesh, by which VertexPoints::of_mesh changed.
struct ChangedVertex {
  Index mesh = 0, vertex = 0;
};

/// The points whose influences changed, and the vertices whose point changed; entries may be
/// repeated. Indices may be beyond the end, where undo removed the elements.
struct ChangeJournal {
  Journal<Index> points;
  Journal<ChangedVertex> vertices;
};

}  // namespace sunder::particles
