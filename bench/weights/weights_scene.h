#pragma once

#include <sunder/operation/pose_spec.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "weights/internal/animation_point.h"

namespace sunder::bench {

/// A point that a tear created between vertices of the source.
struct TornPoint {
  std::uint32_t mesh = 0, vertex = 0;      ///< The first of the vertices that share it.
  Triangle corners = {};                   ///< Vertices of the source.
  std::array<double, 3> barycentric = {};  ///< One per corner.
  std::array<std::span<const Influence>, 3> influences;  ///< One per corner.
  std::array<Vec3d, 3> positions;  ///< The corners in bind space, with the morph weights of rest.
  AnimationPoint exact;            ///< Likewise.

  [[nodiscard]] Vec3d position() const;  ///< In bind space.
  /// Its exact position in a pose: between the posed corners.
  [[nodiscard]] Vec3d posed(const Character& source, std::span<const Affine3d> model_from_bind,
                            std::span<const float> morph_weights) const;
};

/// A model with one tear.
struct TornOnce {
  ModelPose pose;  ///< The pose in which it was torn.
  TornModel model;
  std::vector<TornPoint> points;
};

/// Poses of one kind, all of them computed.
struct Poses {
  PoseSetSpec spec;
  std::vector<ModelPose> fit, held_out;
};

struct WeightsModel {
  std::string name;
  std::shared_ptr<const Character> character;
  /// Diagonal of the box around it at rest, metres. (Bind space may have another unit.)
  double diagonal = 0;
  std::vector<TornOnce> tears;
  std::optional<Poses> clips;  ///< Empty if the model has no clip of non-zero duration.
  Poses range_of_motion;

  [[nodiscard]] std::size_t point_count() const;
  /// Its clips, or a substitute.
  [[nodiscard]] const Poses& usual_poses() const { return clips ? *clips : range_of_motion; }
};

/// Models, each with five seeded tears in poses of its clips or, if it has none, in random poses: a
/// procedural rig, and six rigged files. Absent files are left out, which is reported on stderr.
[[nodiscard]] std::vector<WeightsModel> make_weights_models();

/// model_from_bind of every skin.
[[nodiscard]] std::vector<std::vector<Affine3d>> palettes_of(const Character& character,
                                                             const ModelPose& pose);

}  // namespace sunder::bench
