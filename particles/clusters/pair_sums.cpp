#include "particles/clusters/pair_sums.h"

#include <algorithm>
#include <bit>

namespace sunder::particles {
namespace {

/// A hash table of the sums of pairs of particles, with linear probing.
class PairTable {
 public:
  struct Entry {
    std::uint64_t pair =
        kNoPair;  ///< The lower particle in the high bits, the higher one in the low bits.
    double shared = 0;
    Index points = 0;
  };

  explicit PairTable(std::size_t particles) { entries_.resize(std::bit_ceil(8 * particles + 16)); }

  void add(std::uint64_t pair, double shared) {
    Entry& entry = find(pair);
    ++entry.points;
    entry.shared += shared;
    if (entry.points == 1 && 2 * ++count_ > entries_.size()) grow();
  }

  /// Calls visit(low, high, entry) for all pairs.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const Entry& entry : entries_)
      if (entry.pair != kNoPair)
        visit(static_cast<Index>(entry.pair >> 32u), static_cast<Index>(entry.pair), entry);
  }

 private:
  static constexpr std::uint64_t kNoPair = ~std::uint64_t{0};

  Entry& find(std::uint64_t pair) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = static_cast<std::size_t>((pair * 0x9E37'79B9'7F4A'7C15u) >> 32u) & mask;
    while (entries_[at].pair != pair && entries_[at].pair != kNoPair) at = (at + 1) & mask;
    entries_[at].pair = pair;
    return entries_[at];
  }

  void grow() {
    std::vector<Entry> before(2 * entries_.size());
    before.swap(entries_);
    for (const Entry& entry : before)
      if (entry.pair != kNoPair) find(entry.pair) = entry;
  }

  std::vector<Entry> entries_;  ///< A power of two.
  std::size_t count_ = 0;
};

}  // namespace

void sum_pairs(Structure& structure) {
  PairTable pairs(structure.particles.size());
  // Influences are collected without branches first, because their number per point is
  // unpredictable.
  struct Common {
    std::uint64_t pair;
    double shared;
  };
  std::array<Common, 512> gathered;
  std::size_t count = 0;
  const auto take = [&] {
    for (std::size_t i = 0; i < count; ++i) pairs.add(gathered[i].pair, gathered[i].shared);
    count = 0;
  };
  for (const ParticleInfluences& of : structure.points.influences) {
    if (count + 6 > gathered.size()) take();
    for (std::size_t i = 0; i < 4; ++i) {
      structure.particles[of.particles[i]].weight += double{of.weights[i]};
      for (std::size_t j = 0; j < i; ++j) {
        const Index low = std::min(of.particles[i], of.particles[j]),
                    high = std::max(of.particles[i], of.particles[j]);
        gathered[count] = {std::uint64_t{low} << 32u | high,
                           double{of.weights[i]} * double{of.weights[j]}};
        count += static_cast<std::size_t>(of.weights[i] > 0);
      }
    }
  }
  take();
  pairs.for_each([&](Index low, Index high, const PairTable::Entry& of) {
    structure.particles[low].neighbours.push_back({high, of.points, of.shared});
    structure.particles[high].neighbours.push_back({low, of.points, of.shared});
  });
  for (Particle& particle : structure.particles)
    std::ranges::sort(particle.neighbours, {}, &ParticleNeighbour::particle);
}

}  // namespace sunder::particles
