#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>
#include <sunder/operation/pose_spec.h>
#include <sunder/operation/weight_options.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace sunder {

/// One position of a blade: a straight cutting edge from `base` to `tip`. Model space, metres.
struct Blade {
  Vec3d base = Vec3d::Zero();  ///< Outside the surface.
  Vec3d tip = Vec3d::Zero();   ///< How deep the blade reaches.

  bool operator==(const Blade&) const = default;
};

/// Successive blade positions; each pair of neighbours sweeps one segment.
using Stroke = std::vector<Blade>;

/// Selects the surfaces within reach of a blade that are torn.
enum class Layers : std::uint8_t {
  nearest,  ///< The first one that the blade meets.
  all,      ///< Every one that the blade passes through.
};

struct TearOptions {
  /// Width of the gap, posed metres, >= 0. With 0 the lips coincide and no surface is removed.
  double width = 0.0;
  Layers layers = Layers::nearest;
  /// Depth of the inner walls along the blade, posed metres, >= 0. With 0 there are no walls.
  double wall_depth = 0.0;
  std::optional<WeightOptions> weights = {};  ///< For new points; if empty, the model's options.
  /// Material of the walls, an index in the source file. kNone: that of the lips.
  std::uint32_t wall_material = kNone;
  /// Radius of the rims that walls begin with: lips rolled outwards. Posed metres, >= 0.
  double lip_roll = 0.0;

  bool operator==(const TearOptions&) const = default;
};

/// A half-line in model space.
struct SectionRay {
  Vec3d origin = Vec3d::Zero();
  Vec3d direction = Vec3d(1.0, 0.0, 0.0);  ///< Any length except zero.

  bool operator==(const SectionRay&) const = default;
};

/// A cut by a plane, in model space. A section is a connected run of faces that the plane meets
/// within the bounds.
struct PlaneCut {
  Vec3d point = Vec3d::Zero();          ///< On the plane.
  Vec3d normal = Vec3d(0.0, 0.0, 1.0);  ///< Towards the left lip; any length except zero.
  /// Corners of a convex polygon, which is projected onto the plane and limits the cut. Empty: the
  /// whole plane cuts.
  std::vector<Vec3d> bounds;
  bool caps = false;  ///< Closes the opened sections, where their rims are closed loops.
  /// Places in model space. If not empty, only the section nearest to each of them is cut.
  std::vector<Vec3d> sections = {};
  std::optional<WeightOptions> weights = {};  ///< For new points; if empty, the model's options.
  /// If given, only the section is cut that this ray, projected onto the plane, meets first.
  std::optional<SectionRay> first_hit = {};
  /// Name of a bone. If not empty, only sections are cut that this bone and those below it move by
  /// more than half, on average along the section.
  std::string bone = {};
  /// Material of the caps, an index in the source file. kNone: that of the rim.
  std::uint32_t cap_material = kNone;

  bool operator==(const PlaneCut&) const = default;
};

/// A round hole, in model space.
struct Bore {
  Vec3d origin = Vec3d::Zero();             ///< Start of the axis, outside the surface.
  Vec3d direction = Vec3d(0.0, 0.0, -1.0);  ///< Direction of the axis; any length except zero.
  double radius = 0.0;                      ///< Metres; > 0.
  double depth = 0.0;                       ///< From the origin along the axis, metres; > 0.
  /// Largest distance between the polygonal rim and the circle, metres: 2.5e-6 to 1 of the radius.
  /// 0: 1 % of it.
  double chord_tolerance = 0.0;
  bool wall = false;  ///< Lines the bore with a wall, from rim to rim or down to a floor.
  std::optional<WeightOptions> weights = {};  ///< For new points; if empty, the model's options.
  /// Material of the wall, an index in the source file. kNone: that of the rim.
  std::uint32_t wall_material = kNone;

  bool operator==(const Bore&) const = default;
};

/// Closes wounds again, in model space. Lips are joined where they lie on one another in bind
/// space: those of tears without width and of cuts. A lip that a gap or bore made has nothing to
/// lie on.
struct Weld {
  /// Places in model space. If not empty, only the wound nearest to each of them is closed.
  std::vector<Vec3d> places;
  /// How far from those places along the wound, posed metres. 0: to its ends. A wound that is
  /// closed a bit farther in each frame heals.
  double reach = 0.0;

  bool operator==(const Weld&) const = default;
};

/// Threads that hold wounds together, in model space: a thread joins two surface points, one of
/// either lip, that lie on one another in bind space, and pulls them together. It changes no
/// surface; tissue that moves feels it (SoftBody).
struct Suture {
  /// Places in model space. If not empty, only the wound nearest to each of them is sewn.
  std::vector<Vec3d> places;
  /// How far from those places along the wound, posed metres. 0: to its ends.
  double reach = 0.0;
  /// Distance between threads along the wound, posed metres, > 0. Where the points of the lips are
  /// farther apart, so are the threads.
  double spacing = 0.01;
  double stiffness = 1e4;  ///< Of a thread, newtons per metre, > 0.
  /// With which a thread was tied, newtons, >= 0: a weaker pull does not part its lips.
  double tension = 0.0;
  double strength = 0.0;  ///< Newtons at which a thread breaks; 0: it never does.

  bool operator==(const Suture&) const = default;
};

/// A tear, `{"op": "tear"}` in a log.
struct TearOperation {
  /// The pose changes to `pose` at blade `blade`: the segment that ends with that blade is torn in
  /// the new pose.
  struct PoseChange {
    std::uint32_t blade = 0;
    PoseSpec pose;
  };
  PoseSpec pose;                         ///< Pose at the first blade. Default: rest.
  Stroke stroke;                         ///< Model space, metres. At least two blades.
  std::vector<PoseChange> pose_changes;  ///< Ascending by blade, each > 0.
  TearOptions options;
};

/// A cut, `{"op": "cut"}` in a log.
struct CutOperation {
  PoseSpec pose;
  PlaneCut cut;
};

/// A bore, `{"op": "drill"}` in a log.
struct DrillOperation {
  PoseSpec pose;
  Bore bore;
};

/// A piece named by one of its triangles.
struct PieceOfTriangle {
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;  ///< In the model as it is torn so far.

  bool operator==(const PieceOfTriangle&) const = default;
};

/// The piece whose surface is nearest to a place in model space, in the pose of the operation.
struct PieceNear {
  Vec3d point = Vec3d::Zero();
  std::string bone = {};  ///< If not empty, only triangles that this bone moves most count.

  bool operator==(const PieceNear&) const = default;
};

/// A place on a piece: a connected component of the surface.
using PiecePlace = std::variant<PieceOfTriangle, PieceNear>;

/// Takes a piece off the model, `{"op": "detach"}` in a log.
struct DetachOperation {
  PoseSpec pose;
  PiecePlace piece;
};

/// Closes wounds, `{"op": "weld"}` in a log.
struct WeldOperation {
  PoseSpec pose;
  Weld weld;
};

/// Sews wounds, `{"op": "suture"}` in a log.
struct SutureOperation {
  PoseSpec pose;
  Suture suture;
};

/// Assigns new weights to points that earlier operations created, `{"op": "weights"}` in a log.
struct WeightsOperation {
  std::uint32_t first_operation = 0;      ///< Counted from the oldest one that is not undone.
  std::uint32_t operation_count = kNone;  ///< kNone: all from `first_operation` on.
  WeightOptions weights;
  PoseSpec pose;       ///< The pose for the policy `pose_exact`.
  RefitOptions refit;  ///< Options for the policy `refit`.
};

/// Reverts the most recent operations that are not undone yet, `{"op": "undo"}` in a log.
struct UndoOperation {
  std::uint32_t count = 1;
};

/// Reapplies the operations most recently undone, `{"op": "redo"}` in a log.
struct RedoOperation {
  std::uint32_t count = 1;
};

using Operation =
    std::variant<TearOperation, CutOperation, DrillOperation, WeightsOperation, UndoOperation,
                 RedoOperation, DetachOperation, WeldOperation, SutureOperation>;

}  // namespace sunder
