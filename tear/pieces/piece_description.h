#pragma once

#include <sunder/tear/report.h>

#include <vector>

#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// A piece of the surface, described face by face.
class PieceDescription {
 public:
  PieceDescription(const SurfaceEditor& editor, PosedPoints& posed);

  /// By ascending number.
  void add(Index face);
  [[nodiscard]] bool is_empty() const { return piece_.triangle_count == 0; }
  /// The piece of those faces. To be called once.
  [[nodiscard]] TornPiece piece();

 private:
  const SurfaceEditor& editor_;
  PosedPoints& posed_;
  TornPiece piece_;
  std::vector<std::vector<Index>> triangles_;  ///< Of each mesh.
  std::vector<bool> has_bone_;
  Vec3d moment_ = Vec3d::Zero(), sum_ = Vec3d::Zero();
};

}  // namespace sunder::tear
