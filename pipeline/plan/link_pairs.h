#pragma once

#include <sunder/plan/plan.h>

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::plan {

/// Radius of a ball around the origin of a collider's frame that holds it.
[[nodiscard]] double radius_of(const Collider& collider);

/// The distance of two colliders; below 0 where they overlap. Of two boxes that are apart, a lower
/// bound: the widest gap along a face normal or a normal of two edges.
[[nodiscard]] double distance_between(const Collider& a, const Collider& b);

/// Shapes of links that could meet: those of links that are no neighbours in the robot. Left out
/// are pairs that overlap at rest or in 0.35 of random values, whose shapes are coarser than the
/// links.
class LinkPairs {
 public:
  struct Near {
    std::size_t a = 0, b = 0;  ///< In PlanTool::shapes.
    double distance = 0;
  };

  LinkPairs() = default;
  /// @param tool  valid. Kept by reference.
  explicit LinkPairs(const PlanTool& tool);

  [[nodiscard]] bool is_empty() const { return pairs_.empty(); }
  /// The least distance of a pair, at most `most`.
  /// @param frames  of all links.
  [[nodiscard]] Near nearest(std::span<const Affine3d> frames, double most) const;
  /// The pairs that overlap.
  [[nodiscard]] std::vector<Near> overlaps(std::span<const Affine3d> frames) const;

 private:
  [[nodiscard]] double distance(const Near& pair, std::span<const Affine3d> frames,
                                double most) const;
  void leave_out_coarse_ones();

  const PlanTool* tool_ = nullptr;
  std::vector<Near> pairs_;
  std::vector<double> radii_;  ///< Of balls around the shapes' origins.
};

}  // namespace sunder::plan
