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

/// "3k", "31k", "171k", "900k"; of two divisions "14k".
[[nodiscard]] std::string size_name(int divisions);

/// One surface at one of four sizes, skinned to 64 bones, in a bend, and a stroke across about a
/// hundred of its faces: at each size from the same place in the same direction, the shorter the
/// smaller the faces are.
///
/// The surface is the Stanford bunny (../shared/models) or, where that is absent, a ball with bumps
/// of about as many points. The stroke has four segments whose blades lie in one plane and are
/// parallel, so what it sweeps is one rectangle.
struct Scene {
  std::shared_ptr<const Character> character;  ///< One mesh with normals and one UV set.
  std::vector<ModelPose> poses;  ///< Bends that differ by less than a face is wide: the stroke
                                 ///< crosses about the same faces.
  Stroke stroke;
  std::uint32_t faces_crossed = 0;  ///< By the stroke, in the first pose.
  PlaneCut middle_plane;            ///< Through the mean of the points, across the longest axis.

  [[nodiscard]] const Mesh& mesh() const { return character->meshes[0]; }
  /// Whoever does something with it takes it back.
  [[nodiscard]] TornModel& model() const { return *model_; }
  /// A pose other than that of the call before.
  [[nodiscard]] const ModelPose& next_pose() const { return poses[++turn_ % poses.size()]; }

 private:
  friend const Scene& scene_of(int divisions);

  std::unique_ptr<TornModel> model_;
  mutable std::size_t turn_ = 0;
};

/// The scene of a size; made when it is first asked for, then kept.
[[nodiscard]] const Scene& scene_of(int divisions);

/// Posed positions of the scene's mesh by the double-precision reference.
[[nodiscard]] std::vector<Vec3d> posed_positions(const Scene& scene, const ModelPose& pose);

}  // namespace sunder::bench
