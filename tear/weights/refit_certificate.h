#pragma once

#include <sunder/certificate/certificate.h>
#include <sunder/core/character.h>

#include <optional>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder::tear {

/// Bounds how far weighted points can stray from their exact motion in any pose, with free joints:
/// docs/method/certificate.md. A bound is infinity for a point without a certificate.
///
/// A root may slide without limit. Weights that differ across one (of a rig with several) by no
/// more than rounding, 4e-6, are in no bound: a pose in which it slides by d metres from bind may
/// exceed a bound by 4e-6 d.
class RefitCertificate {
 public:
  /// Points without a certificate everywhere if the skeleton has none: bones that are singular at
  /// bind.
  explicit RefitCertificate(const Character& character);

  /// Adds a point with some weights. @param skin  of the point.
  void add(const AnimationPoint& exact, std::span<const Influence> influences,
           const Vec3d& position, std::uint32_t skin);
  /// The bounds of the points that were added since, metres. Empties the list.
  /// @throws std::bad_alloc; the points are lost then.
  [[nodiscard]] std::vector<double> take_bounds();

 private:
  const Character& character_;
  ModelPose bind_;
  std::optional<JointTree> tree_;
  SkinDifferences rows_;
};

}  // namespace sunder::tear
