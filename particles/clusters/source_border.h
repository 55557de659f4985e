#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::particles {

/// The border that the surface had before it was torn. Copies share it.
class SourceBorder {
 public:
  SourceBorder() = default;
  /// O(triangles); of a torn model O(triangles log triangles).
  explicit SourceBorder(const TornModel& model);

  /// Whether a half-edge of the torn surface lies on it.
  [[nodiscard]] bool has(Index half_edge, const TornModel& model) const;
  /// Without what other copies share.
  [[nodiscard]] std::size_t memory_bytes() const {
    return half_edges_.use_count() == 1 ? half_edges_->capacity() * sizeof(Index) : 0;
  }

 private:
  std::shared_ptr<const std::vector<Index>> half_edges_;  ///< Of the source, ascending.
};

}  // namespace sunder::particles
