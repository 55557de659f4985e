#include "tear/contact/searches.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/contact/segment_hit.h"

namespace sunder::tear {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// A half-line, clipped to boxes.
class Line {
 public:
  Line(const Vec3d& base, const Vec3d& way) : base_(base), way_(way) {
    for (int k = 0; k < 3; ++k) per_step_[k] = 1 / way[k];
    reach_ = kPosedCoordinates * base.cwiseAbs().maxCoeff();
  }

  /// Where the line enters a box, at least 0; infinity if it misses it or enters beyond `most`.
  [[nodiscard]] double entry(const ModelBox& box, double most) const {
    double begin = 0, end = most;
    for (int k = 0; k < 3; ++k) {
      const double to_low = box.low[k] - base_[k] - reach_,
                   to_high = box.high[k] - base_[k] + reach_;
      if (way_[k] == 0) {
        if (to_low > 0 || to_high < 0) return kNowhere;
        continue;
      }
      const bool ascends = way_[k] > 0;
      begin = std::max(begin, (ascends ? to_low : to_high) * per_step_[k]);
      end = std::min(end, (ascends ? to_high : to_low) * per_step_[k]);
    }
    return begin <= end ? begin : kNowhere;
  }

 private:
  Vec3d base_, way_, per_step_;
  double reach_;
};

/// A lower bound of the squared distance of a box and another one.
double squared_gap(const ModelBox& a, const ModelBox& b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0, a.low[k] - b.high[k], b.low[k] - a.high[k]});
    sum += gap * gap;
  }
  return sum;
}

ModelBox box_of(const Vec3d& a, const Vec3d& b) { return {a.cwiseMin(b), a.cwiseMax(b)}; }

/// A lower bound of the squared distance of a box and a segment.
class SegmentDistance {
 public:
  SegmentDistance(const Vec3d& base, const Vec3d& tip)
      : base_(base), way_(tip - base), box_(box_of(base, tip)), square_(squared_norm(way_)) {}

  [[nodiscard]] double least(const ModelBox& box) const {
    const double of_boxes = squared_gap(box, box_);
    if (!(square_ > 0)) return of_boxes;
    const Vec3d middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    if (!half.allFinite()) return 0;
    // The box lies in the ball around it: better for a long segment that lies askew.
    const double along = std::clamp(dot(middle - base_, way_) / square_, 0.0, 1.0);
    const double gap = norm(Vec3d(base_ + along * way_ - middle)) - (1 + kBoxSizes) * norm(half);
    return gap > 0 ? std::max(of_boxes, gap * gap * (1 - kBoxSizes)) : of_boxes;
  }

 private:
  Vec3d base_, way_;
  ModelBox box_;
  double square_;
};

bool is_on_edge(const FoundPlace& at) {
  return std::ranges::any_of(at.barycentric,
                             [](double part) { return part < kSamePlaceBarycentric; });
}

/// Removes the crossings of edges and points that another face lists too, on the same side.
void remove_repeated(const Vec3d& way, const Vec3d& base, std::vector<FoundPlace>& found) {
  const double same = kSamePlaceBarycentric *
                      (1 + base.cwiseAbs().maxCoeff() / std::max(norm(way), kShortestMetres));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    bool is_repeated = false;
    for (std::size_t k = kept; k-- > 0 && found[i].along - found[k].along <= same;)
      is_repeated = is_repeated || (found[k].enters == found[i].enters && is_on_edge(found[k]) &&
                                    is_on_edge(found[i]));
    if (!is_repeated) found[kept++] = found[i];
  }
  found.resize(kept);
}

}  // namespace

std::optional<FoundPlace> first_on_line(const Vec3d& base, const Vec3d& way, double most,
                                        PosedSurface& surface) {
  const Line line(base, way);
  std::optional<FoundPlace> first;
  double limit = most;
  const auto bound = [&](const ModelBox& box) { return line.entry(box, limit); };
  surface.visit_faces(bound, [&](Index face) {
    const auto hit = hit_of_segment(base, way, surface.corners(face));
    const bool is_first =
        hit && hit->along <= limit && (!first || hit->along < limit || face < first->face);
    if (!is_first) return limit;
    first = {face, hit->barycentric, hit->along, 0, hit->enters};
    limit = hit->along;
    return limit;
  });
  return first;
}

void all_on_segment(const Vec3d& base, const Vec3d& way, PosedSurface& surface,
                    std::vector<FoundPlace>& found) {
  const Line line(base, way);
  found.clear();
  const auto bound = [&](const ModelBox& box) { return line.entry(box, 1); };
  surface.visit_faces(bound, [&](Index face) {
    const auto hit = hit_of_segment(base, way, surface.corners(face));
    if (hit && hit->along <= 1)
      found.push_back({face, hit->barycentric, hit->along, 0, hit->enters});
    return 1.0;
  });
  std::sort(found.begin(), found.end(), [](const FoundPlace& a, const FoundPlace& b) {
    return a.along != b.along ? a.along < b.along : a.face < b.face;
  });
  remove_repeated(way, base, found);
}

std::optional<FoundPlace> nearest_to_segment(const Vec3d& base, const Vec3d& tip,
                                             double most_squared, PosedSurface& surface) {
  const SegmentDistance distance(base, tip);
  std::optional<FoundPlace> nearest;
  double limit = most_squared;
  const auto bound = [&](const ModelBox& box) {
    const double least = distance.least(box);
    return least <= limit ? least : kNowhere;
  };
  surface.visit_faces(bound, [&](Index face) {
    const NearestPlaces places = nearest_of_segment(base, tip, surface.corners(face));
    const bool is_nearest = places.squared_distance <= limit &&
                            (!nearest || places.squared_distance < limit || face < nearest->face);
    if (!is_nearest) return limit;
    nearest = {face, places.barycentric, places.along, places.squared_distance, true};
    limit = places.squared_distance;
    return limit;
  });
  return nearest;
}

double squared_distance_to(const Corners& triangle, double most, PosedSurface& surface) {
  ModelBox around = box_of(triangle[0], triangle[1]);
  around = {around.low.cwiseMin(triangle[2]), around.high.cwiseMax(triangle[2])};
  double least = most;
  const auto bound = [&](const ModelBox& box) {
    const double gap = squared_gap(box, around);
    return gap <= least ? gap : kNowhere;
  };
  surface.visit_faces(bound, [&](Index face) {
    least = std::min(least, squared_distance(triangle, surface.corners(face)));
    return least;
  });
  return least;
}

}  // namespace sunder::tear
