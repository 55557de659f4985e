#pragma once

#include <sunder/core/math.h>
#include <sunder/operation/pose_spec.h>
#include <sunder/operation/weight_options.h>

#include <cstdint>
#include <variant>
#include <vector>

namespace sunder {

/// One sample of a blade, model space, metres: a straight edge that reaches from the handle to the
/// point.
struct Blade {
  Vec3d base = Vec3d::Zero();  ///< Outside the surface.
  Vec3d tip = Vec3d::Zero();   ///< How deep the blade reaches.

  bool operator==(const Blade&) const = default;
};

/// Successive blade positions; each two neighbours sweep one segment.
using Stroke = std::vector<Blade>;

/// Which of the surfaces that a blade reaches are torn.
enum class Layers : std::uint8_t {
  nearest,  ///< The one that it meets first.
  all,      ///< Every one that it passes.
};

struct TearOptions {
  double width =
      0.0;  ///< Of the gap, posed metres; >= 0. 0: the lips coincide and no surface is lost.
  Layers layers = Layers::nearest;
  double wall_depth =
      0.0;  ///< Of the inner walls that the lips get, along the blade, posed metres; >= 0. 0: none.
  std::optional<WeightOptions> weights = {};  ///< Of the points that it makes; none: the model's.

  bool operator==(const TearOptions&) const = default;
};

/// A cut by a plane, in model space.
struct PlaneCut {
  Vec3d point = Vec3d::Zero();          ///< On the plane.
  Vec3d normal = Vec3d(0.0, 0.0, 1.0);  ///< Towards the left lip; any length but zero.
  /// Corners of a convex polygon, projected onto the plane, outside of which nothing is cut. Empty:
  /// the whole plane.
  std::vector<Vec3d> bounds;
  bool caps = false;  ///< Close what the cut opens, where it opens closed loops.
  std::optional<WeightOptions> weights = {};  ///< Of the points that it makes; none: the model's.

  bool operator==(const PlaneCut&) const = default;
};

/// A round hole, in model space.
struct Bore {
  Vec3d origin = Vec3d::Zero();             ///< Where the axis begins, outside the surface.
  Vec3d direction = Vec3d(0.0, 0.0, -1.0);  ///< Of the axis; any length but zero.
  double radius = 0.0;                      ///< Metres; > 0.
  double depth = 0.0;                       ///< From the origin along the axis, metres; > 0.
  double chord_tolerance =
      0.0;  ///< How far the rim may stray from the circle, metres. 0: one per cent of the radius.
  bool wall = false;  ///< Line the bore: from rim to rim, or down to a floor.
  std::optional<WeightOptions> weights = {};  ///< Of the points that it makes; none: the model's.

  bool operator==(const Bore&) const = default;
};

/// {"op": "tear"}
struct TearOperation {
  /// From blade `blade` on the character stands in `pose`: the segment that ends with that blade is
  /// torn in it.
  struct PoseChange {
    std::uint32_t blade = 0;
    PoseSpec pose;
  };
  PoseSpec pose;                         ///< Of the first blade. Default: rest.
  Stroke stroke;                         ///< Model space, metres. At least two blades.
  std::vector<PoseChange> pose_changes;  ///< Ascending by blade, each > 0.
  TearOptions options;
};

/// {"op": "cut"}
struct CutOperation {
  PoseSpec pose;
  PlaneCut cut;
};

/// {"op": "drill"}
struct DrillOperation {
  PoseSpec pose;
  Bore bore;
};

/// {"op": "weights"}: gives points that earlier operations made other weights.
struct WeightsOperation {
  std::uint32_t first_operation = 0;  ///< Of those that are done and not taken back, oldest first.
  std::uint32_t operation_count = kNone;  ///< kNone: all from there on.
  WeightOptions weights;
  PoseSpec pose;       ///< That `pose_exact` meets.
  RefitOptions refit;  ///< Of `refit`.
};

/// {"op": "undo"}: takes back the newest operations that are not yet taken back.
struct UndoOperation {
  std::uint32_t count = 1;
};

/// {"op": "redo"}: does again what was taken back last.
struct RedoOperation {
  std::uint32_t count = 1;
};

using Operation = std::variant<TearOperation, CutOperation, DrillOperation, WeightsOperation,
                               UndoOperation, RedoOperation>;

}  // namespace sunder
