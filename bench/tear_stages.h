#pragma once

#include "bench/tear_scene.h"
#include "tear/posed/posed_points.h"
#include "tear/surface/surface_editor.h"

namespace sunder::bench {

/// Seconds per stage of a tear.
struct Stages {
  double pose = 0;     ///< The new pose is taken in.
  double query = 0;    ///< Finding where the stroke enters the surface.
  double imprint = 0;  ///< Its path becomes edges; new vertices get their attributes.
  double attributes =
      0;               ///< A part of `imprint`: the attributes and weights of those vertices alone.
  double open = 0;     ///< The surface opens along the edges.
  double improve = 0;  ///< Turning edges along the tear.
  double change_record = 0;  ///< Writing the change record.

  [[nodiscard]] double sum() const {
    return pose + query + imprint + open + improve + change_record;
  }
};

/// A tear in slow motion: the steps that a stroke takes, on a surface of its own, each timed
/// and all taken back.
class StagedTear {
 public:
  explicit StagedTear(const Scene& scene);
  StagedTear(const StagedTear&) = delete;

  Stages run();
  /// The entry alone, on the whole surface: `pose` and `query`.
  Stages run_query();

 private:
  void begin_pose(Stages& stages);
  void tear_segment(const Blade& from, const Blade& to, Stages& stages);
  /// The interpolation of these births once more, on arrays of the model's size.
  double time_attributes();

  const Scene& scene_;
  Character character_;
  tear::SurfaceEditor editor_;
  tear::PosedPoints posed_;
  Index tip_ = kNone;
  std::vector<LipPair> lips_;
  std::vector<Birth> births_;  ///< Weights of the vertices that the imprint created.
  ChangeRecord change_;
  Mesh replay_;
};

}  // namespace sunder::bench
