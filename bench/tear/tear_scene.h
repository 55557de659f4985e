#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace sunder::bench {

/// Each face of the base model becomes n x n faces: about 3.5, 31, 171 and 892 thousand points.
inline constexpr std::array<int, 4> kDivisions = {1, 3, 7, 16};
inline constexpr int kSmallest = kDivisions.front(), kLargest = kDivisions.back();

/// "3k", "31k", "171k", "900k"; "14k" for two divisions.
[[nodiscard]] std::string size_name(int divisions);

/// One surface at one of four sizes, skinned to 64 bones and bent, and a stroke across about a
/// hundred of its faces. The stroke has the same start and direction at each size, and is shorter
/// if the faces are smaller.
///
/// The surface is the Stanford bunny (../shared/models) or, if that is absent, a ball with bumps
/// and about as many points. The stroke has four segments with parallel blades in one plane, so it
/// sweeps a rectangle.
struct Scene {
  std::shared_ptr<const Character> character;  ///< One mesh with normals and one UV set.
  /// Bends that differ by less than the width of a face, so that the stroke crosses about the same
  /// faces.
  std::vector<ModelPose> poses;
  Stroke stroke;
  std::uint32_t faces_crossed = 0;  ///< By the stroke, in the first pose.
  PlaneCut middle_plane;            ///< Through the mean of the points, across the longest axis.

  [[nodiscard]] const Mesh& mesh() const { return character->meshes[0]; }
  /// Users must undo their changes.
  [[nodiscard]] TornModel& model() const { return *model_; }
  /// Another pose than in the previous call.
  [[nodiscard]] const ModelPose& next_pose() const { return poses[++turn_ % poses.size()]; }

 private:
  friend const Scene& scene_of(int divisions);

  std::unique_ptr<TornModel> model_;
  mutable std::size_t turn_ = 0;
};

/// The scene of a size; created on first use, then kept.
[[nodiscard]] const Scene& scene_of(int divisions);

/// Posed positions of the scene's mesh by the double-precision reference.
[[nodiscard]] std::vector<Vec3d> posed_positions(const Scene& scene, const ModelPose& pose);

}  // namespace sunder::bench
