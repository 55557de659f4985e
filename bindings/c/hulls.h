#pragma once

#include <sunder/bodies/convex_hulls.h>

#include <cstdint>
#include <sunder_c.h>
#include <utility>
#include <vector>

#include "bindings/c/numbers.h"

namespace sunder::c {

/// Convex hulls as C sees them.
class HullViews {
 public:
  void set(std::vector<ConvexHull> hulls) {
    std::vector<sunder_hull> views;
    for (const ConvexHull& hull : hulls)
      views.push_back({numbers_of(hull.points), numbers_of(hull.triangles), count_of(hull.points),
                       count_of(hull.triangles), hull.part, 0, hull.volume});
    hulls_ = std::move(hulls);  // moving the lists keeps their arrays where they are
    views_ = std::move(views);
  }
  /// Valid until the next set().
  void get(const sunder_hull** hulls, std::uint32_t* count) const {
    *hulls = views_.data();
    *count = count_of(views_);
  }

 private:
  std::vector<ConvexHull> hulls_;
  std::vector<sunder_hull> views_;
};

}  // namespace sunder::c
