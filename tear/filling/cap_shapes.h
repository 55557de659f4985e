#pragma once

#include <list>
#include <span>

#include "tear/section/flat_section.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// A triangulated region of a section, and the values that were extended into it.
struct CapShape {
  explicit CapShape(ScratchMemory& scratch)
      : loop_sizes(&scratch), places(&scratch), flat(scratch), values(&scratch) {}

  ScratchVector<std::size_t> loop_sizes;
  ScratchVector<Vec2d> places;  ///< Of the rim, then of the inner points.
  std::size_t rim_count = 0;
  FlatMesh flat;
  ScratchVector<double> values;  ///< A row per place; empty until they were extended once.
};

/// The shapes of a section. Both sides of a cut have the same rims, so each shape is made once and
/// used twice.
class CapShapes {
 public:
  explicit CapShapes(ScratchMemory& scratch) : scratch_(scratch), shapes_(&scratch) {}

  /// The shape of a region, whose loops begin with the same points whatever side they come from.
  /// @return null if the region cannot be triangulated.
  [[nodiscard]] CapShape* of(std::span<const FlatLoop> loops, const FlatRegion& region);

  /// Extends the values of the rim to the inner points, or copies those of the other side if it had
  /// the same.
  /// @param values  a row per place; those of the rim are read, the others written.
  void extend(CapShape& shape, ScratchVector<double>& values);

 private:
  ScratchMemory& scratch_;
  std::pmr::list<CapShape> shapes_;
};

}  // namespace sunder::tear
