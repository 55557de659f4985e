#pragma once

#include <list>
#include <span>

#include "tear/section/flat_section.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// A triangulated region of a section, and the cap that was made from it first.
struct CapShape {
  explicit CapShape(ScratchMemory& scratch)
      : loop_sizes(&scratch),
        places(&scratch),
        flat(scratch),
        first_cap{kNone, false, false, ScratchVector<Index>(&scratch)} {}

  struct Cap {
    Index mesh;  ///< kNone if there is none yet.
    bool is_inside_out;
    bool is_flat;                   ///< Whether stored positions leave a triangle no area.
    ScratchVector<Index> vertices;  ///< Per place.
  };

  ScratchVector<std::size_t> loop_sizes;
  ScratchVector<Vec2d> places;  ///< Of the rim, then of the inner points.
  std::size_t rim_count = 0;
  FlatMesh flat;
  Cap first_cap;
};

/// The shapes of a section. Both sides of a cut have the same rims, so each shape is made once and
/// used twice.
class CapShapes {
 public:
  explicit CapShapes(ScratchMemory& scratch) : scratch_(scratch), shapes_(&scratch) {}

  /// The shape of a region, whose loops begin with the same points whatever side they come from.
  /// @return null if the region cannot be triangulated.
  [[nodiscard]] CapShape* of(std::span<const FlatLoop> loops, const FlatRegion& region);

 private:
  /// @return false if the region cannot be triangulated.
  [[nodiscard]] bool triangulate_into(FlatMesh& flat, std::size_t rim_count,
                                      std::span<const FlatLoop> loops, const FlatRegion& region);

  ScratchMemory& scratch_;
  std::pmr::list<CapShape> shapes_;
};

}  // namespace sunder::tear
