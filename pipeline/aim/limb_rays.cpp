#include "pipeline/aim/limb_rays.h"

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
constexpr double kLeastRayLimb = 0.2;

/// Surfaces nearer to one another than this share of the width are one, or its two sides.
constexpr double kSameSurfaceWidths = 1e-6;

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
      if (is_moved_by_limb(line.face)) section_faces_.push_back(line.face);
      for (const Vec3d& end : line.ends) {
        const double across = dot(end - limb.place, frame.across);
        left = std::min(left, across);
        right = std::max(right, across);
      }
    }
  width_ = right - left;
  middle_ = limb.place + 0.5 * (left + right) * frame.across;
}

bool LimbRays::is_moved_by_limb(Index face) const {
  const LimbShares shares = limb_.bones.shares_of_face(face);
  return shares.limb() >= kLeastRayLimb && shares.limb() + shares.parent() >= kLeastLimbAndParent;
}

bool LimbRays::may_belong(Index face, double reach) const {
  if (!is_moved_by_limb(face)) return false;
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
  is_of_section_ = is_of_limb_;
  for (const Index face : section_faces_) is_of_section_[face] = true;
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

HitHeights LimbRays::all_hits(const Vec3d& offset, const std::vector<bool>& is_limb) const {
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
    if (is_limb[face])
      (is_facing ? hits.facing : hits.averted).push_back({height, face});
    else
      (limb_.bones.shares_of_face(face).limb() >= 0.5 ? hits.kin : hits.others)
          .push_back({height, face});
  }
  return hits;
}

RayHit LimbRays::hit_at(const MetFace& met, double far, const HitHeights& hits) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const double near = met.height;
  RayHit hit{near, far, met.face, kInfinite, kInfinite, kInfinite};
  const auto limit = [&](const std::vector<MetFace>& faces, double least) {
    for (const auto& [height, face] : faces) {
      if (height > near + least) hit.free_before = std::min(hit.free_before, height - near);
      if (height < far - least) hit.free_behind = std::min(hit.free_behind, far - height);
    }
  };
  limit(hits.others, 0);
  for (const std::vector<MetFace>* const faces : {&hits.facing, &hits.averted, &hits.kin})
    limit(*faces, kSameSurfaceWidths * width_);
  for (const auto& [height, face] : hits.others)
    if (height < near) hit.free_below = std::min(hit.free_below, near - height);
  return hit;
}

std::optional<RayHit> LimbRays::cast_at_middle() const {
  const HitHeights hits = all_hits(Vec3d::Zero(), is_of_section_);
  const auto highest = [](const std::vector<MetFace>& faces) {
    return faces.empty() ? MetFace{-std::numeric_limits<double>::infinity(), kNone}
                         : *std::ranges::max_element(faces, {}, &MetFace::height);
  };
  // The inside of the limb is not its near surface. A single sheet may be seen from behind.
  const MetFace near = highest(hits.facing.empty() ? hits.averted : hits.facing);
  if (near.face == kNone || (hits.facing.empty() && highest(hits.others).height > near.height))
    return {};
  double far = near.height;
  for (const MetFace& met : hits.averted) far = std::min(far, met.height);
  return hit_at(near, far, hits);
}

std::optional<RayHit> LimbRays::cast(const Vec3d& offset, const RayHit& neighbour) const {
  const HitHeights hits = all_hits(offset, is_of_limb_);
  const auto nearest = [](const std::vector<MetFace>& faces, double expected) {
    return *std::ranges::min_element(
        faces, {}, [&](const MetFace& met) { return std::abs(met.height - expected); });
  };
  const std::vector<MetFace>& candidates = hits.facing.empty() ? hits.averted : hits.facing;
  if (candidates.empty()) return {};
  const MetFace near = nearest(candidates, neighbour.near);
  double far = near.height;
  if (!hits.averted.empty()) far = std::min(far, nearest(hits.averted, neighbour.far).height);
  const RayHit hit = hit_at(near, far, hits);
  const bool is_hidden_sheet = hits.facing.empty() && hit.free_before < neighbour.free_before;
  return is_hidden_sheet ? std::optional<RayHit>() : hit;
}

LimbShares LimbRays::shares_at(const Vec3d& offset, const RayHit& hit) const {
  std::array<Vec2d, 3> seen;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d from = limb_.surface.corners(hit.near_face)[k] - middle_ - offset;
    seen[k] = {dot(from, frame_.across), dot(from, frame_.along)};
  }
  const Vec2d ray(0, 0);
  const double whole = area(seen[0], seen[1], seen[2]);
  LimbShares shares;
  for (Index k = 0; k < 3; ++k)
    shares.add(limb_.bones.shares(limb_.surface.point(3 * hit.near_face + k)),
               area(ray, seen[(k + 1) % 3], seen[(k + 2) % 3]) / whole);
  return shares;
}

bool LimbRays::meets_others(const Vec3d& offset, double low, double high) const {
  const std::vector<MetFace> others = all_hits(offset, is_of_limb_).others;
  return std::ranges::any_of(
      others, [&](const MetFace& met) { return met.height > low && met.height < high; });
}

}  // namespace sunder::aim
