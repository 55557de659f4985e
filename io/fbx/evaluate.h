#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <vector>

#include "io/fbx/scene.h"

namespace sunder::fbx {

/// The transform of a node in its parent: `translation * rotation * scale`.
struct Local {
  Vec3d translation = Vec3d::Zero();
  Mat3d rotation = Mat3d::Identity();
  Vec3d scale = Vec3d::Ones();
};

/// The transform of a node in the scene: `translation * rotation * shape`, as the inheritance of
/// scales needs them apart.
struct Global {
  Vec3d translation = Vec3d::Zero();
  Mat3d rotation = Mat3d::Identity();
  Mat3d shape = Mat3d::Identity();
};

/// Evaluates models at moments of one take; without a take, at rest.
class Evaluator {
 public:
  /// @param scene, take  must outlive this object; `take` may be null.
  Evaluator(const Scene& scene, const Take* take);

  /// Whether an ancestor of a model is scaled, at rest or in the take.
  [[nodiscard]] bool is_below_scale(std::uint32_t model) const { return is_below_scale_[model]; }
  /// Appends the times, in ticks, between which the curves of a model are smooth.
  void append_times(std::uint32_t model, std::vector<double>& ticks) const;

  [[nodiscard]] Local local(std::uint32_t model, double ticks) const;
  [[nodiscard]] Global global(std::uint32_t model, double ticks) const;

 private:
  struct Driven {
    const Layer* layer;
    const CurveNode* node;
  };
  [[nodiscard]] bool is_scaled(std::uint32_t model) const;
  [[nodiscard]] Stack stack_at(std::uint32_t model, double ticks) const;

  const Scene& scene_;
  const Layer* lowest_ = nullptr;              ///< Its values replace those at rest.
  std::vector<std::vector<Driven>> nodes_of_;  ///< Per model, the lowest layer first.
  std::vector<bool> is_below_scale_;           ///< Per model.
};

}  // namespace sunder::fbx
