#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <vector>

#include "tear/internal/surface.h"

namespace sunder::aim {

/// The torn surface of a model in a pose.
class PosedSurface {
 public:
  /// @return the failures of make_pose(); size_mismatch, non_finite_value. O(points).
  [[nodiscard]] static Result<PosedSurface> create(const TornModel& model, const PoseSpec& spec);

  [[nodiscard]] const Character& character() const { return *character_; }
  [[nodiscard]] const tear::Surface& surface() const { return *surface_; }
  [[nodiscard]] const ModelPose& pose() const { return pose_; }
  [[nodiscard]] Index face_count() const { return surface_->triangle_count(); }
  /// Whether a face is neither retired nor degenerate.
  [[nodiscard]] bool is_live(Index face) const { return is_live_[face]; }
  [[nodiscard]] Index point(Index corner) const { return surface_->corner_point[corner]; }
  [[nodiscard]] const Vec3d& position(Index point) const { return positions_[point]; }
  [[nodiscard]] std::array<Vec3d, 3> corners(Index face) const {
    return {positions_[point(3 * face)], positions_[point(3 * face + 1)],
            positions_[point(3 * face + 2)]};
  }
  [[nodiscard]] double area(Index face) const;
  /// A vertex of a point: its mesh and its index there; kNone for a point without faces.
  [[nodiscard]] std::array<Index, 2> vertex(Index point) const;
  [[nodiscard]] Vec3d joint(Index bone) const { return pose_.model_from_bone[bone].translation(); }
  [[nodiscard]] double size() const { return size_; }  ///< Longest side of the box, metres.

 private:
  PosedSurface() = default;
  const Character* character_ = nullptr;
  const tear::Surface* surface_ = nullptr;
  ModelPose pose_;
  std::vector<Vec3d> positions_;  ///< Per point; zero for a point without faces.
  std::vector<bool> is_live_;     ///< Per face.
  double size_ = 0;
};

}  // namespace sunder::aim
