#pragma once

#include <sunder/particles/soft_body.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <span>
#include <vector>

#include "tools/posed_model.h"

namespace sunder::tools {

/// Lets lips open for pictures, in any pose: tissue under an even tension.
class OpenLips {
 public:
  /// @param model  before its first operation.
  static Result<OpenLips> create(const TornModel& model);

  /// To be called after each operation, with what it told.
  Status follow(const TornModel& model, std::span<const ChangeRecord> changes);
  /// A sixtieth of a second.
  Status step(const TornModel& model, const ModelPose& pose);
  /// Until nothing moves any more, or for three seconds.
  Status open(const TornModel& model, const ModelPose& pose);

  /// Moves positions as the tissue has moved.
  void displace(std::vector<DeformedMesh>& posed) const;

 private:
  OpenLips() = default;

  std::unique_ptr<ParticleSet> particles_;
  std::unique_ptr<SoftBody> body_;
};

}  // namespace sunder::tools
