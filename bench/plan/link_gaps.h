#pragma once

#include <sunder/plan/plan.h>

#include <cstddef>
#include <span>
#include <vector>

namespace sunder::bench {

/// The gap between two colliders, none of them a half-space, within 1e-5 of their sizes; 0 or below
/// if they overlap. Alternating projections onto the cores (von Neumann 1950), which are a place, a
/// segment or a box, until a plane between them shows that the gap is no wider.
[[nodiscard]] double gap_between(const Collider& a, const Collider& b);

/// Pairs of an arm's shapes that have to keep apart by the rule of docs/plan.md. Nothing of it is
/// shared with plans: distances are found by projections, joints are compared where they rest.
class LinkGaps {
 public:
  struct Pair {
    std::size_t a = 0, b = 0;  ///< In PlanTool::shapes.
  };

  /// @param tool  valid; kept by reference.
  explicit LinkGaps(const PlanTool& tool);

  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  /// The gap of a pair, at most `most`.
  /// @param frames  of all links.
  [[nodiscard]] double gap(const Pair& pair, std::span<const Affine3d> frames, double most) const;
  /// The least gap of all pairs, at most `most`; 0 or below where two overlap.
  [[nodiscard]] double least(std::span<const Affine3d> frames, double most) const;

 private:
  const PlanTool& tool_;
  std::vector<Pair> pairs_;
};

}  // namespace sunder::bench
