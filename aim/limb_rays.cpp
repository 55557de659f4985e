#include "aim/limb_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

/// A face belongs to the limb if the limb and its parent move at least so much of it …
constexpr double kLeastLimbAndParent = 0.5;
/// … and the limb itself at least this.
constexpr double kLeastLimb = 0.2;

/// Twice the signed area of a triangle in the plane of the view.
double area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace

LimbRays::LimbRays(const Limb& limb, const ViewFrame& frame, std::span<const Section> sections)
    : limb_(limb), frame_(frame) {
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const Section& section : sections)
    for (const Section::Line& line : section.lines) {
      section_faces_.push_back(line.face);
      for (const Vec3d& end : line.ends) {
        const double across = dot(end - limb.place, frame.across);
        left = std::min(left, across);
        right = std::max(right, across);
      }
    }
  width_ = right - left;
  middle_ = limb.place + 0.5 * (left + right) * frame.across;
}

bool LimbRays::may_belong(Index face, double reach) const {
  const LimbShares shares = limb_.bones.shares_of_face(face);
  if (shares.limb() < kLeastLimb || shares.limb() + shares.parent() < kLeastLimbAndParent)
    return false;
  const std::array<Vec3d, 3> corners = limb_.surface.corners(face);
  // Faces beyond the reach on one side along the limb are another part of it: a bent forearm is
  // not in front of its upper arm.
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3d& corner : corners) {
    const double along = dot(corner - middle_, frame_.along);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  return low <= reach && high >= -reach;
}

void LimbRays::look_around(double reach) {
  const tear::Surface& surface = limb_.surface.surface();
  is_of_limb_.assign(limb_.surface.face_count(), false);
  std::vector<Index> open;
  for (const Index face : section_faces_) {
    if (is_of_limb_[face]) continue;
    is_of_limb_[face] = true;
    open.push_back(face);
  }
  while (!open.empty()) {
    const Index face = open.back();
    open.pop_back();
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      if (surface.twin[h] == kNone) continue;
      const Index other = surface.twin[h] / 3;
      if (is_of_limb_[other] || !limb_.surface.is_live(other) || !may_belong(other, reach))
        continue;
      is_of_limb_[other] = true;
      open.push_back(other);
    }
  }
}

HitHeights LimbRays::all_hits(const Vec3d& offset) const {
  HitHeights hits;
  for (Index face = 0; face < limb_.surface.face_count(); ++face) {
    if (!limb_.surface.is_live(face)) continue;
    const std::array<Vec3d, 3> corners = limb_.surface.corners(face);
    std::array<Vec2d, 3> seen;
    std::array<double, 3> heights;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d from = corners[k] - middle_ - offset;
      seen[k] = {dot(from, frame_.across), dot(from, frame_.along)};
      heights[k] = dot(from, frame_.towards_viewer);
    }
    const Vec2d ray(0, 0);
    const double a = area(ray, seen[1], seen[2]), b = area(ray, seen[2], seen[0]),
                 c = area(ray, seen[0], seen[1]);
    const double whole = a + b + c;
    if (whole == 0 || std::min({a / whole, b / whole, c / whole}) < 0) continue;
    const double height = (a * heights[0] + b * heights[1] + c * heights[2]) / whole;
    // `across` and `along` are left-handed as seen by the viewer.
    const bool is_facing = whole < 0;
    if (is_of_limb_[face])
      (is_facing ? hits.facing : hits.averted).push_back(height);
    else
      (limb_.bones.shares_of_face(face).limb() >= 0.5 ? hits.kin : hits.others).push_back(height);
  }
  return hits;
}

std::optional<RayHit> LimbRays::cast(const Vec3d& offset) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const HitHeights hits = all_hits(offset);
  const auto highest = [](const std::vector<double>& heights) {
    return heights.empty() ? -kInfinite : *std::max_element(heights.begin(), heights.end());
  };
  const auto lowest = [](const std::vector<double>& heights) {
    return heights.empty() ? kInfinite : *std::min_element(heights.begin(), heights.end());
  };
  // The inside of the limb is not its near surface, where that belongs to another limb. A single
  // sheet may be seen from behind.
  const double near_averted = highest(hits.averted);
  const bool is_sheet = hits.facing.empty() && near_averted > highest(hits.others);
  RayHit hit;
  hit.near = is_sheet ? near_averted : highest(hits.facing);
  if (hit.near == -kInfinite) return {};
  hit.far = std::min({hit.near, lowest(hits.facing), lowest(hits.averted)});
  hit.free_before = hit.free_below = hit.free_behind = kInfinite;
  for (const double height : hits.others)
    if (height < hit.near) hit.free_below = std::min(hit.free_below, hit.near - height);
  for (const std::vector<double>* const heights : {&hits.kin, &hits.others})
    for (const double height : *heights) {
      if (height > hit.near) hit.free_before = std::min(hit.free_before, height - hit.near);
      if (height < hit.far) hit.free_behind = std::min(hit.free_behind, hit.far - height);
    }
  return hit;
}

bool LimbRays::meets_others(const Vec3d& offset, double low, double high) const {
  const std::vector<double> others = all_hits(offset).others;
  return std::any_of(others.begin(), others.end(),
                     [&](double height) { return height > low && height < high; });
}

}  // namespace sunder::aim
