#include "tear/filling/cap_shapes.h"

#include <algorithm>

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
  auto flat = triangulate(loops, region, InnerPoints::graded, scratch_);
  if (!flat) {
    shapes_.pop_back();
    return nullptr;
  }
  wanted.flat = std::move(*flat);
  wanted.places.insert(wanted.places.end(), wanted.flat.inner.begin(), wanted.flat.inner.end());
  return &wanted;
}

void CapShapes::extend(CapShape& shape, ScratchVector<double>& values) {
  const std::size_t channels = values.size() / shape.places.size();
  const auto rim_end = static_cast<std::ptrdiff_t>(shape.rim_count * channels);
  if (shape.values.size() == values.size() &&
      std::equal(values.begin(), values.begin() + rim_end, shape.values.begin())) {
    std::copy(shape.values.begin() + rim_end, shape.values.end(), values.begin() + rim_end);
    return;
  }
  extend_harmonically(shape.places, shape.flat, channels, values, scratch_);
  if (shape.values.empty()) shape.values = values;
}

}  // namespace sunder::tear
