#pragma once

#include <sunder/particles/fitted_colliders.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/torn_model.h>

#include <cstdint>
#include <span>
#include <vector>

#include "bench/plan/plan_cases.h"

namespace sunder::bench {

/// How deep links of an arm are in the rig, by its posed vertices, random places of its faces and
/// the nearest place of its surface: nothing of it is shared with plans.
class LinkDepth {
 public:
  explicit LinkDepth(const PlanCase& of);

  /// The deepest vertex of a link's meshes below the surface at a time, metres; infinity if the
  /// pose cannot be made. The blade's link is left out.
  /// @param frames  of all links, in model space.
  double deepest_vertex(double time, std::span<const Affine3d> frames);

  /// The least distance of shapes of links from the surface at a time, metres, at most `most`;
  /// below 0 inside. The blade's link is left out.
  double least_distance(double time, std::span<const Affine3d> frames, double most);

  /// Whether a blade is above the surface between its base and a place at which it enters it.
  bool is_blade_outside(double time, const Vec3d& base, const Vec3d& entry);

 private:
  /// The rig at a time.
  struct Moment {
    double time = 0;
    std::vector<Vec3d> places;
    SurfaceQuery query;
    bool is_posed = false;
  };
  Moment& at(double time);

  const PlanCase& of_;
  TornModel model_;
  std::vector<SurfaceAnchor> anchors_;        ///< On faces.
  std::vector<std::vector<Vec3d>> vertices_;  ///< Some of each link.
  std::vector<Moment> moments_;
};

}  // namespace sunder::bench
