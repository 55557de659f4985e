#include "tear/surface/opened_edges.h"

#include <algorithm>
#include <cstdint>

namespace sunder::tear {
namespace {

constexpr std::size_t kLeastSlots = 64;

}  // namespace

void OpenedEdges::begin(bool is_wanted) {
  is_wanted_ = is_wanted;
  if (count_ > 0) std::fill(slots_.begin(), slots_.end(), kNone);
  count_ = 0;
  changes_.clear();
  borders_.clear();
  is_rolled_back_ = false;
}

std::vector<Index> OpenedEdges::tracked() const {
  std::vector<Index> tracked;
  for (const Index h : slots_)
    if (h < surface_.twin.size() && surface_.corner_point[h] != kNone) tracked.push_back(h);
  std::sort(tracked.begin(), tracked.end());
  return tracked;
}

const std::vector<Index>& OpenedEdges::borders() {
  if (is_rolled_back_) borders_ = slots_;
  is_rolled_back_ = false;
  std::erase_if(borders_, [this](Index h) {
    return h == kNone || !contains(h) || surface_.twin[h] != kNone ||
           surface_.corner_point[h] == kNone;
  });
  std::sort(borders_.begin(), borders_.end());
  borders_.erase(std::unique(borders_.begin(), borders_.end()), borders_.end());
  return borders_;
}

/// As IndexMap::place_of().
std::size_t OpenedEdges::place_of(Index half_edge) const {
  return (std::uint64_t{half_edge * 2654435769u} * slots_.size()) >> 32;
}

std::size_t OpenedEdges::slot_of(Index half_edge) const {
  std::size_t slot = place_of(half_edge);
  while (slots_[slot] != kNone && slots_[slot] != half_edge) slot = (slot + 1) % slots_.size();
  return slot;
}

void OpenedEdges::insert(Index half_edge) {
  // Memory first, so that nothing fails after the set has changed.
  if (2 * (count_ + 1) > slots_.size()) grow();
  borders_.push_back(half_edge);
  const std::size_t slot = slot_of(half_edge);
  if (slots_[slot] == half_edge) return;
  changes_.push_back({half_edge, true});
  slots_[slot] = half_edge;
  ++count_;
}

void OpenedEdges::grow() {
  std::vector<Index> old(std::max(kLeastSlots, 2 * slots_.size()), kNone);
  old.swap(slots_);
  for (const Index h : old)
    if (h != kNone) slots_[slot_of(h)] = h;
}

bool OpenedEdges::remove(Index half_edge) {
  if (!is_wanted_ || !contains(half_edge)) return false;
  changes_.push_back({half_edge, false});
  free_slot(slot_of(half_edge));
  return true;
}

/// Moves later entries up, so that a search meets no gap before them. Knuth, The Art of Computer
/// Programming, volume 3, section 6.4, algorithm R.
void OpenedEdges::free_slot(std::size_t slot) noexcept {
  const std::size_t size = slots_.size();
  for (std::size_t i = (slot + 1) % size; slots_[i] != kNone; i = (i + 1) % size) {
    const std::size_t from_place = (i + size - place_of(slots_[i])) % size;
    if (from_place < (i + size - slot) % size) continue;  // its place is behind the free slot
    slots_[slot] = slots_[i];
    slot = i;
  }
  slots_[slot] = kNone;
  --count_;
}

void OpenedEdges::roll_back(Index change_count) noexcept {
  is_rolled_back_ = true;
  for (; changes_.size() > change_count; changes_.pop_back()) {
    const auto [half_edge, is_insertion] = changes_.back();
    const std::size_t slot = slot_of(half_edge);
    if (is_insertion) {
      free_slot(slot);
    } else {
      slots_[slot] = half_edge;
      ++count_;
    }
  }
}

}  // namespace sunder::tear
