#pragma once

#include <memory>

#include "pipeline/binding/welded_surface.h"

namespace sunder::binding {

/// Answers whether a point of a surface sees a place inside it.
class Sight {
 public:
  /// @param surface  is kept by reference.
  explicit Sight(const WeldedSurface& surface);
  ~Sight();

  /// Whether the way from a point to a place meets no other triangle of the point's own part and,
  /// where that is closed, stays inside it. Other parts do not hide: the body under a garment is no
  /// wall to its bones.
  [[nodiscard]] bool is_clear(Index point, const Vec3d& place) const;

 private:
  [[nodiscard]] bool is_inside(Index part, const Vec3d& place) const;

  struct Tree;
  const WeldedSurface& surface_;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace sunder::binding
