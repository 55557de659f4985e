#pragma once

#include <sunder/particles/particle_set.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace sunder::particles {

/// The memberships of all points, one after the other: those of the decomposition, which copies
/// share, and after them those that tears append, so that a tear never moves all.
class MembershipList {
 public:
  [[nodiscard]] std::size_t size() const { return decomposed_->size() + appended_.size(); }
  /// The number of those of the decomposition.
  [[nodiscard]] std::size_t decomposed_count() const { return decomposed_->size(); }
  /// Some memberships, all of the decomposition or all appended.
  [[nodiscard]] std::span<const ParticleMembership> at(std::size_t first, std::size_t count) const {
    const std::size_t before = decomposed_->size();
    return {first < before ? decomposed_->data() + first : appended_.data() + (first - before),
            count};
  }
  /// Those from a place on, which is not within those of the decomposition.
  [[nodiscard]] std::span<const ParticleMembership> from(std::size_t first) const {
    return std::span(appended_).subspan(first - decomposed_->size());
  }

  void set_decomposed(std::vector<ParticleMembership> all) {
    decomposed_ = std::make_shared<const std::vector<ParticleMembership>>(std::move(all));
    appended_.clear();
  }
  void append(std::span<const ParticleMembership> more) {
    appended_.insert(appended_.end(), more.begin(), more.end());
  }
  /// Replaces those that tears appended.
  void set_appended(std::vector<ParticleMembership> all) { appended_ = std::move(all); }
  /// Drops memberships at the end. @param count  at least that of the decomposition.
  void shrink(std::size_t count) {
    appended_.resize(std::min(appended_.size(), count - decomposed_->size()));
  }
  /// Makes room for more.
  void reserve(std::size_t more) {
    if (appended_.capacity() < appended_.size() + more)
      appended_.reserve(appended_.size() + more + appended_.size() / 2 + 1024);
  }
  /// Those of the decomposition count for the last one that has them.
  [[nodiscard]] std::size_t memory_bytes() const {
    return appended_.capacity() * sizeof(ParticleMembership) +
           (decomposed_.use_count() == 1 ? decomposed_->capacity() * sizeof(ParticleMembership)
                                         : 0);
  }

 private:
  std::shared_ptr<const std::vector<ParticleMembership>> decomposed_ =
      std::make_shared<const std::vector<ParticleMembership>>();
  std::vector<ParticleMembership> appended_;
};

}  // namespace sunder::particles
