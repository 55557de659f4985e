#include "tear/contact/searches.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "tear/contact/segment_hit.h"

namespace sunder::tear {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// A half-line, clipped to boxes of a frame.
class RayLine {
 public:
  RayLine(const Vec3d& base, const Vec3d& way, const Frame& frame)
      : base_(frame.place_of(base)),
        way_(multiply(frame.axes, way)),
        per_step_(way_.cwiseInverse()),
        rounding_(kPosedCoordinates * std::max(frame.reach(), base.cwiseAbs().maxCoeff())) {}

  /// Where the line enters a box, at least 0; infinity if it misses it or enters beyond `most`.
  [[nodiscard]] double entry(const FrameBox& box, double most) const {
    double begin = 0, end = most;
    for (int k = 0; k < 3; ++k) {
      const double to_low = box.low[k] - base_[k] - rounding_,
                   to_high = box.high[k] - base_[k] + rounding_;
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
  double rounding_;
};

/// A lower bound of the squared distance of a box and another one.
double squared_gap(const FrameBox& a, const FrameBox& b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0, a.low[k] - b.high[k], b.low[k] - a.high[k]});
    sum += gap * gap;
  }
  return sum;
}

FrameBox box_of(const Vec3d& a, const Vec3d& b) { return {a.cwiseMin(b), a.cwiseMax(b)}; }
FrameBox box_of(const Corners& corners) {
  const FrameBox box = box_of(corners[0], corners[1]);
  return {box.low.cwiseMin(corners[2]), box.high.cwiseMax(corners[2])};
}

/// A lower bound of the squared distance of a box and a segment.
class SegmentDistance {
 public:
  SegmentDistance(const Vec3d& base, const Vec3d& tip, const Frame& frame)
      : base_(frame.place_of(base)),
        way_(multiply(frame.axes, Vec3d(tip - base))),
        box_(box_of(base_, frame.place_of(tip))),
        square_(squared_norm(way_)) {}

  [[nodiscard]] double least(const FrameBox& box) const {
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
  FrameBox box_;
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
  const Frame frame = surface.frame();
  const RayLine line(base, way, frame);
  std::optional<FoundPlace> first;
  double limit = most;
  const auto bound = [&](const FrameBox& box) { return line.entry(box, limit); };
  surface.visit_faces(frame, bound, [&](Index face) {
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
  const Frame frame = surface.frame();
  const RayLine line(base, way, frame);
  found.clear();
  const auto bound = [&](const FrameBox& box) { return line.entry(box, 1); };
  surface.visit_faces(frame, bound, [&](Index face) {
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
  const Frame frame = surface.frame();
  const SegmentDistance distance(base, tip, frame);
  std::optional<FoundPlace> nearest;
  double limit = most_squared;
  const auto bound = [&](const FrameBox& box) {
    const double least = distance.least(box);
    return least <= limit ? least : kNowhere;
  };
  const FrameBox of_segment = box_of(base, tip);
  surface.visit_faces(frame, bound, [&](Index face) {
    const Corners corners = surface.corners(face);
    if ((1 - kBoxSizes) * squared_gap(box_of(corners), of_segment) > limit) return limit;
    const NearestPlaces places = nearest_of_segment(base, tip, corners);
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
  const Frame frame = surface.frame();
  const FrameBox around = box_of(
      {frame.place_of(triangle[0]), frame.place_of(triangle[1]), frame.place_of(triangle[2])});
  double least = most;
  const auto bound = [&](const FrameBox& box) {
    const double gap = squared_gap(box, around);
    return gap <= least ? gap : kNowhere;
  };
  surface.visit_faces(frame, bound, [&](Index face) {
    least = std::min(least, squared_distance(triangle, surface.corners(face)));
    return least;
  });
  return least;
}

}  // namespace sunder::tear
