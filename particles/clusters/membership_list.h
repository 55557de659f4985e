#pragma once

#include <sunder/particles/particle_set.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace sunder::particles {

/// The memberships of all points, one after the other: those of the decomposition, which copies
/// share, and after them those that tears append. A tear moves neither.
class MembershipList {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The number of those of the decomposition.
  [[nodiscard]] std::size_t decomposed_count() const { return decomposed_->size(); }
  /// Some memberships, all of the decomposition or all of those that were appended together.
  [[nodiscard]] std::span<const ParticleMembership> at(std::size_t first, std::size_t count) const {
    if (first < decomposed_->size() || count == 0)
      return {decomposed_->data() + std::min(first, decomposed_->size()), count};
    const Chunk& chunk = chunks_[chunk_of(first)];
    return {chunk.memberships.data() + (first - chunk.first), count};
  }
  /// Those from the end of the decomposition on, up to `end`.
  [[nodiscard]] std::vector<ParticleMembership> appended(std::size_t end) const {
    std::vector<ParticleMembership> all;
    for (const Chunk& of : chunks_) {
      if (of.first >= end) break;
      const std::size_t count = std::min(of.memberships.size(), end - of.first);
      all.insert(all.end(), of.memberships.begin(),
                 of.memberships.begin() + static_cast<std::ptrdiff_t>(count));
    }
    return all;
  }

  void set_decomposed(std::vector<ParticleMembership> all) {
    decomposed_ = std::make_shared<const std::vector<ParticleMembership>>(std::move(all));
    size_ = decomposed_->size();
    chunks_.clear();
  }
  /// @param room  for so many more memberships of the same point, see replace().
  /// @throws std::bad_alloc, with nothing changed
  void append(std::span<const ParticleMembership> more, std::size_t room = 0) {
    const std::size_t count = more.size() + room;
    if (chunks_.empty() || chunks_.back().memberships.size() + count > kChunk) {
      Chunk chunk{size_, {}};
      if (!chunks_.empty()) chunk.memberships.reserve(std::max(kChunk, count));
      chunks_.push_back(std::move(chunk));  // the first one is that of a small tear, perhaps
    }
    std::vector<ParticleMembership>& last = chunks_.back().memberships;
    if (last.capacity() < last.size() + count)
      last.reserve(std::max(2 * last.capacity(), last.size() + count));
    last.insert(last.end(), more.begin(), more.end());
    last.insert(last.end(), room, kRoom);
    size_ += count;
  }
  /// Replaces memberships that were appended together, if there is room behind them for those that
  /// are more. @return whether there was; otherwise nothing changes.
  [[nodiscard]] bool replace(std::size_t first, std::size_t count,
                             std::span<const ParticleMembership> by) {
    Chunk& chunk = chunks_[chunk_of(first)];
    const std::span<ParticleMembership> from =
        std::span(chunk.memberships).subspan(first - chunk.first);
    if (by.size() > from.size()) return false;
    for (std::size_t i = count; i < by.size(); ++i)
      if (from[i].particle != kRoom.particle) return false;
    std::copy(by.begin(), by.end(), from.begin());
    for (std::size_t i = by.size(); i < count; ++i) from[i] = kRoom;
    return true;
  }
  /// Replaces those that tears appended.
  void set_appended(std::vector<ParticleMembership> all) {
    chunks_.clear();
    size_ = decomposed_->size() + all.size();
    if (!all.empty()) chunks_.push_back({decomposed_->size(), std::move(all)});
  }
  /// Drops memberships at the end. @param count  at least that of the decomposition.
  void shrink(std::size_t count) {
    size_ = std::min(size_, count);
    while (!chunks_.empty() && chunks_.back().first >= size_) chunks_.pop_back();
    if (!chunks_.empty()) chunks_.back().memberships.resize(size_ - chunks_.back().first);
  }
  /// Those of the decomposition count for the last one that has them.
  [[nodiscard]] std::size_t memory_bytes() const {
    std::size_t bytes = chunks_.capacity() * sizeof(Chunk);
    for (const Chunk& of : chunks_) bytes += of.memberships.capacity() * sizeof(ParticleMembership);
    return bytes + (decomposed_.use_count() == 1
                        ? decomposed_->capacity() * sizeof(ParticleMembership)
                        : 0);
  }

 private:
  /// Memberships that were appended one after the other; those of a point are in one chunk.
  struct Chunk {
    std::size_t first;  ///< The place of the first one in the list.
    std::vector<ParticleMembership> memberships;
  };
  static constexpr std::size_t kChunk = 16384;  ///< Memberships.
  /// An entry that is none.
  static constexpr ParticleMembership kRoom = {kNone, 0};

  /// The chunk with a place that was appended: the last one that does not begin later.
  [[nodiscard]] std::size_t chunk_of(std::size_t place) const {
    const auto after =
        std::upper_bound(chunks_.begin(), chunks_.end(), place,
                         [](std::size_t at, const Chunk& of) { return at < of.first; });
    return static_cast<std::size_t>(after - chunks_.begin()) - 1;
  }

  std::shared_ptr<const std::vector<ParticleMembership>> decomposed_ =
      std::make_shared<const std::vector<ParticleMembership>>();
  std::vector<Chunk> chunks_;  ///< Not empty each.
  std::size_t size_ = 0;
};

}  // namespace sunder::particles
