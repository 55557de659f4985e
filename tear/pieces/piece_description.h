#pragma once

#include <sunder/tear/report.h>

#include <vector>

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// Collects the description of a piece face by face.
class PieceDescription {
 public:
  PieceDescription(const SurfaceEditor& editor, PosedPoints& posed);

  /// Faces must be added in ascending order.
  void add(Index face);
  [[nodiscard]] bool is_empty() const { return piece_.triangle_count == 0; }
  /// The piece of the added faces. Call it once.
  [[nodiscard]] TornPiece piece();

 private:
  const SurfaceEditor& editor_;
  PosedPoints& posed_;
  TornPiece piece_;
  std::vector<std::vector<Index>> triangles_;  ///< Per mesh.
  std::vector<bool> has_bone_;
  Vec3d moment_ = Vec3d::Zero(), sum_ = Vec3d::Zero();
};

}  // namespace sunder::tear
