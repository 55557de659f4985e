#pragma once

#include "bench/tear/tear_scene.h"
#include "tear/posed/posed_points.h"
#include "tear/surface/surface_editor.h"

namespace sunder::bench {

/// Seconds per stage of a tear.
struct Stages {
  double pose = 0;           ///< Taking in the new pose.
  double query = 0;          ///< Finding where the stroke enters the surface.
  double imprint = 0;        ///< Turning the path into edges, with attributes of new vertices.
  double attributes = 0;     ///< Part of `imprint`: the attributes and weights of those vertices.
  double open = 0;           ///< Opening the surface along the edges.
  double improve = 0;        ///< Turning edges along the tear.
  double change_record = 0;  ///< Writing the change record.

  [[nodiscard]] double sum() const {
    return pose + query + imprint + open + improve + change_record;
  }
};

/// The steps of a tear, on a separate surface, each timed; all are undone.
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
  /// Interpolates these births again, on arrays of the model's size.
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
