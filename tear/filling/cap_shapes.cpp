#include "tear/filling/cap_shapes.h"

#include <algorithm>

#include "tear/section/graded_points.h"

namespace sunder::tear {

CapShape* CapShapes::of(std::span<const FlatLoop> loops, const FlatRegion& region) {
  CapShape& wanted = shapes_.emplace_back(scratch_);
  const auto append = [&](Index loop) {
    wanted.loop_sizes.push_back(loops[loop].size());
    wanted.rim_count += loops[loop].size();
  };
  append(region.outline);
  for (const Index hole : region.holes) append(hole);
  wanted.places.reserve(wanted.rim_count);
  const auto place = [&](Index loop) {
    wanted.places.insert(wanted.places.end(), loops[loop].begin(), loops[loop].end());
  };
  place(region.outline);
  for (const Index hole : region.holes) place(hole);

  const auto known = std::find_if(shapes_.begin(), std::prev(shapes_.end()), [&](CapShape& shape) {
    return shape.loop_sizes == wanted.loop_sizes &&
           std::equal(wanted.places.begin(), wanted.places.end(), shape.places.begin());
  });
  if (known != std::prev(shapes_.end())) {
    shapes_.pop_back();
    return &*known;
  }
  if (!triangulate_into(wanted.flat, wanted.rim_count, loops, region)) {
    shapes_.pop_back();
    return nullptr;
  }
  wanted.places.insert(wanted.places.end(), wanted.flat.inner.begin(), wanted.flat.inner.end());
  return &wanted;
}

/// The memory of the triangulation is used again by later steps; it is much more than the result.
bool CapShapes::triangulate_into(FlatMesh& flat, std::size_t rim_count,
                                 std::span<const FlatLoop> loops, const FlatRegion& region) {
  const std::size_t most_inner = most_graded_points(rim_count);
  const std::size_t most_triangles = rim_count + 2 * region.holes.size() + 2 * most_inner;
  flat.inner.reserve(most_inner);
  flat.triangles.reserve(most_triangles);
  flat.twins.reserve(3 * most_triangles);
  const ScratchMemory::Frame frame(scratch_);
  const auto made = triangulate(loops, region, InnerPoints::graded, scratch_);
  if (!made) return false;
  flat.inner.assign(made->inner.begin(), made->inner.end());
  flat.triangles.assign(made->triangles.begin(), made->triangles.end());
  flat.twins.assign(made->twins.begin(), made->twins.end());
  return true;
}

}  // namespace sunder::tear
