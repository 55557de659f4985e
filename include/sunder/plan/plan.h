#pragma once

#include <sunder/operation/operation.h>
#include <sunder/particles/fitted_colliders.h>
#include <sunder/particles/material.h>
#include <sunder/particles/soft_body.h>
#include <sunder/robot/robot.h>
#include <sunder/robot/trajectory.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/report.h>
#include <sunder/tear/torn_model.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sunder {

// Which motion of a robot, or of a hand, makes a given wound on a character that moves. For
// pipelines. Its library links Ceres, whose Debian package links parts of SuiteSparse that are
// under the GPL. Method, accuracy and figures: docs/plan.md.

/// A curve on the surface of a character, and how a blade shall pass along it.
struct WoundTarget {
  /// At least two places in triangles of the source. Between neighbours the curve follows the
  /// surface below their chord, in the pose in which the motion begins.
  std::vector<SurfaceAnchor> places;
  bool is_closed = false;  ///< It ends where it begins.
  /// How deep the tip is below the surface, metres, > 0: one for the curve, or one per place. In
  /// the first and last 3 % of the length the blade goes down to it, and rises.
  std::vector<double> depth = {0.01};
  /// Between the blade and the surface along the curve, radians, in (0, pi): one for the curve, or
  /// one per place. Below a right angle the blade's base leans in the direction of travel.
  std::vector<double> angle = {std::numbers::pi / 2};
  /// How wide the wound shall gape in soft tissue, metres: one number where it is widest, or one
  /// per place, of which the first and the last are 0. {0}: not asked for. A closed curve has none.
  std::vector<double> gape = {0};
};

/// The curve on a character that is like the wound of another one: the longest run of lips of a
/// tear without width and walls. In the rest poses each place is carried by the bones that move it:
/// from joint to joint, turned and scaled as the limb below it; the nearest place of the surface is
/// taken. Bones correspond by name, or by the name without namespace, case and separators; one
/// without counterpart by the nearest above. Method: docs/plan.md.
/// @param torn  the other character, as a torn file or TornModel::character() has it.
/// @return depth, angle and gape are the defaults of WoundTarget; the first fault of a character;
///         not_found if there are no such lips, or no bone corresponds. Allocates.
[[nodiscard]] SUNDER_API Result<WoundTarget> wound_like(
    const Character& torn, const std::shared_ptr<const Character>& character);

/// When the character is in which pose, and how long the motion takes.
struct PlanTiming {
  PoseSpec pose;           ///< Of the character when the motion begins.
  double clip_speed = 0;   ///< As tear_of_sweep(): seconds of the clip per second.
  double approach = 0.4;   ///< Seconds from the first place above the surface to the cut; > 0.
  double cut = 1.0;        ///< Seconds for the curve; > 0.
  double retreat = 0.4;    ///< Seconds from the end of the cut to the last place; > 0.
  double standoff = 0.03;  ///< Of the tip above the surface at begin and end, metres; >= 0.
  /// Whether the durations of approach, cut and retreat are the least ones: they grow, all by the
  /// same factor, sixteen at most, until joints keep their speeds.
  bool may_take_longer = false;
};

/// A robot with a blade on one of its links.
struct PlanTool {
  Robot robot;
  MountedBlade blade;
  Affine3d world_from_root = Affine3d::Identity();  ///< In the character's model space.
  /// Shapes of links, bones being links: those that fit_colliders() finds around the robot's
  /// character, better four per link than one. They stay outside of the character but for those of
  /// the blade's link, and outside of one another but for those of neighbours and those that
  /// overlap anyway: docs/plan.md. Links without a shape may be anywhere.
  std::vector<BoneCollider> shapes;
};

struct PlanOptions {
  /// Largest distance of lips and curve, metres; 0: 1 % of the curve's length, and at least half a
  /// thousandth of the diagonal of the posed character.
  double tolerance = 0.0;
  double maximum_acceleration = 0.0;  ///< Of every value, rad/s^2 or m/s^2; 0: no limit.
  double spacing = 0.002;             ///< SweepOptions::spacing of the tear.
  double clearance = 0.005;           ///< Wanted between links and character, metres; > 0.
  std::uint32_t seeds = 24;           ///< Random starts of the inverse kinematics.
  TearOptions tear;                   ///< Of the tear that is made.
  /// Of the tissue, for WoundTarget::gape; empty: the preset "skin".
  std::optional<SoftMaterial> material;
};

/// How much room a value of the robot keeps during a planned motion. Units of the value.
struct ValueMargin {
  std::string name;
  double least = 0, greatest = 0;  ///< Of the value.
  double to_limits = 0;            ///< Least distance from its limits; infinity without limits.
  double greatest_speed = 0, speed_limit = 0;  ///< Per second; limit 0: none.
  double greatest_acceleration = 0;            ///< Per second squared.
};

/// The reason why a motion is not possible.
struct PlanObstacle {
  enum class Kind : std::uint8_t {
    joint_limit,     ///< Without the limit of `value` the blade would come there.
    joint_speed,     ///< `value` would have to move faster than its limit.
    acceleration,    ///< `value` would have to accelerate more than is allowed.
    reach,           ///< No values of the joints, within limits or not, bring the blade there.
    collision,       ///< The link `value` would be inside the character.
    self_collision,  ///< The links `value` and `other` would be inside one another.
    /// Joints follow the curve, but the tear does not: the blade meets other parts of the surface,
    /// or the surface along the curve is not connected.
    wound,
  };
  Kind kind = Kind::reach;
  /// Name in Robot::values, or of a link; empty for `reach` and `wound`.
  std::string value;
  double at = 0;           ///< Share of the curve's length where it is met.
  std::string other = {};  ///< Name of the second link of a `self_collision`.
};

/// How the lips of the torn copy gape as soft tissue.
struct PlannedGape {
  /// Tension::newtons_per_metre. The first guess is that of tension_for_gap(), which is for a flat
  /// surface; it is corrected by what the copy does.
  double tension = 0;
  /// The greatest distance of two points of the lips that were one, metres, when the tissue has
  /// come to rest under that tension in the pose in which the cut ends.
  double widest = 0;
  /// For a gape per place, at even shares of the curve from its begin to its end: the shares of the
  /// tension, 0 to 1, what gapes under them, and what was wanted, metres. Otherwise empty.
  std::vector<double> tension_shares = {}, gape_along = {}, wanted_along = {};
  double most_error = 0;  ///< The largest difference of these two, metres.
};

struct PlanReport {
  double curve_length = 0;  ///< Metres, in the pose in which the motion begins.
  double tolerance = 0;     ///< Metres.
  /// Whether joints bring the blade to all of the curve, within all limits, and the lips that it
  /// tears in a copy are within the tolerance of the curve.
  bool is_reachable = false;
  /// The longest part of the curve that joints reach, shares of its length. 0 and 0: none.
  double first_share = 0, last_share = 0;
  std::vector<PlanObstacle> obstacles;  ///< Empty if reachable; the first one met first.

  // The following is about a reachable curve, or about the last motion that was tried.
  double cut = 0;                       ///< Seconds that the cut takes.
  double cut_begins = 0, cut_ends = 0;  ///< Seconds of the trajectory.
  std::vector<ValueMargin> values;      ///< One per column of the trajectory.
  /// How far the blade is from the moving curve during the cut, metres: at most, and root mean
  /// square.
  double most_place_error = 0, mean_place_error = 0;
  double most_depth_error = 0, mean_depth_error = 0;  ///< Metres.
  double most_angle_error = 0, mean_angle_error = 0;  ///< Radians.
  /// Least distance of a link's shape from the character at 65 times, metres; infinity without
  /// shapes, and if no link comes near.
  double least_clearance = 0;
  /// Least distance of the shapes of two links that are no neighbours, at 257 times, metres; at
  /// most ten times PlanOptions::clearance. Infinity if no two could meet.
  double least_self_clearance = 0;
  /// The motion tears a copy. Largest and mean distance of its lips and the curve from one another,
  /// metres, in the pose in which the cut begins, and the largest one in all sampled poses of
  /// all clips. Infinity if it tears nothing; 0 if no motion was found.
  double hausdorff = 0, mean_distance = 0, hausdorff_in_clips = 0;
  TearReport torn;                  ///< Of that copy, which is torn without width and walls.
  std::optional<PlannedGape> gape;  ///< If one is wanted, of a curve that is reached.
};

struct PlannedMotion {
  PlanReport report;
  /// Only values that move the blade. Empty if not reachable, unless the obstacle is `wound`.
  RobotTrajectory trajectory;
  TearOperation tear;  ///< What it does.
};

/// Finds the motion. The same input gives the same bits on one machine; one thread.
///
/// @param character  satisfies validate_character().
/// @return a motion, or a report that says why there is none; the first fault of character, robot
///         or blade; invalid_argument, index_out_of_range, size_mismatch or non_finite_value, which
///         name the place or the field; empty_input for a curve without length;
///         unsupported_feature for a blade behind a floating joint; limit_exceeded: out of memory.
///         Allocates.
[[nodiscard]] SUNDER_API Result<PlannedMotion> plan_motion(
    const std::shared_ptr<const Character>& character, const WoundTarget& target,
    const PlanTiming& timing, const PlanTool& tool, const PlanOptions& options = {});

/// PlannedGape as SoftBody::set_tension() takes it, for the lips of the tear that was planned.
/// @param planned  of `target` and `timing`.
/// @param model    of the same character, with the tear.
/// @param changes  of the tear.
/// @return the failures of plan_motion() for target and timing; invalid_argument if no gape was
///         planned. Allocates.
[[nodiscard]] SUNDER_API Result<Tension> tension_of_gape(const WoundTarget& target,
                                                         const PlanTiming& timing,
                                                         const PlannedMotion& planned,
                                                         const TornModel& model,
                                                         std::span<const ChangeRecord> changes);

/// Speed and smoothness of a stroke, between 10 and 90 % of the part of the curve that it cuts.
struct StrokePace {
  double seconds = 0;  ///< From the first to the last blade in the surface.
  /// Along the curve, metres per second; wanted: where it is even in PlanTiming::cut.
  double speed = 0, wanted_speed = 0;
  /// Of the times that 16 equal parts take: standard deviation over mean. 0: even.
  double unevenness = 0;
  /// Log dimensionless jerk (Balasubramanian et al. 2012) of the place of the blade that is at the
  /// surface on average, the nearer to 0 the smoother; wanted: that of the curve at the same times,
  /// or of a straight reach of least jerk where that one is greater. Empty for fewer than 16 blades
  /// there.
  std::optional<double> log_jerk, wanted_log_jerk;
};

/// How far a stroke that was performed is from the one that was asked for.
struct StrokeScore {
  /// At most, and on average over the way that the blade cuts.
  struct Error {
    double most = 0, mean = 0;
  };
  /// From 0 to 100. The whole: docs/plan.md.
  struct Marks {
    double whole = 0, covered = 0, place = 0, depth = 0, angle = 0;
    std::optional<double> speed, smoothness;  ///< Empty if they are not known.
  };
  double curve_length = 0, tolerance = 0;  ///< Metres.
  std::size_t blades = 0;                  ///< Of the stroke that cross the surface inwards.
  bool is_backwards = false;               ///< It was made from the curve's end to its begin.
  double covered = 0;  ///< Share of the curve that it cuts, up to five tolerances beside it.
  Error place;         ///< Between the blade's entry and the curve, metres.
  /// Of the tip, metres; 0 where it is not. The first and last 3 % of the curve do not count.
  Error too_deep, too_shallow;
  double wanted_depth = 0;  ///< On average, metres.
  Error angle;              ///< Between the blade and the wanted one, radians.
  std::optional<StrokePace> pace;
  Marks marks;
};

/// Compares a stroke that was performed, by a robot, a hand or a controller, with what was asked
/// for: what a tutor would say about it.
/// @param timing     its pose lays the curve on the surface; its cut gives the speed. Slower is no
///                   fault with PlanTiming::may_take_longer.
/// @param performed  the blades, and the pose of the character at each of them: that of
///                   tear_of_sweep(), or of a log.
/// @param times      one per blade, seconds, increasing; or empty: neither speed nor smoothness are
///                   judged.
/// @param tolerance  metres; 0: as PlanOptions::tolerance.
/// @return the failures of plan_motion() for character, target and timing; empty_input for fewer
///         than two blades; size_mismatch, non_finite_value or invalid_argument, which name the
///         blade. O(blades x (pose + 240)). Allocates.
[[nodiscard]] SUNDER_API Result<StrokeScore> score_stroke(
    const std::shared_ptr<const Character>& character, const WoundTarget& target,
    const PlanTiming& timing, const TearOperation& performed, std::span<const double> times = {},
    double tolerance = 0);

/// Where a robot could stand to make a curve, and what it does there.
struct PlannedBase {
  Vec3d moved = Vec3d::Zero();  ///< From PlanTool::world_from_root, metres, in model space.
  PlannedMotion planned;
};

/// Looks for the nearest place of the robot's root from which all of the curve can be made. The
/// root is moved, not turned: on 24 spheres around where it is, up to where the arm cannot reach
/// the curve, 42 directions each, nearest first; where inverse kinematics reach some places of the
/// curve with links outside of the character, a motion is planned. Between the sphere of the first
/// motion and the one before, halves are tried along that direction, four times.
/// @param tool  whose plan is not reachable from where it stands; that place itself is not tried.
/// @return empty if none of the sixteen nearest places makes it; the failures of plan_motion().
/// Some
///         seconds. Allocates.
[[nodiscard]] SUNDER_API Result<std::optional<PlannedBase>> find_base(
    const std::shared_ptr<const Character>& character, const WoundTarget& target,
    const PlanTiming& timing, const PlanTool& tool, const PlanOptions& options = {});

/// A hand that holds a blade above the middle of a curve: three slides and three turns without
/// limits. Its last link carries the blade along z, the tip in the origin; base to tip lie along
/// the surface's normal when the turns are 0. A blade across the curve, flat on the surface, is
/// singular.
/// @param length  of the blade, metres, > 0.
/// @return the failures of plan_motion() for character, target and timing; invalid_argument.
[[nodiscard]] SUNDER_API Result<PlanTool> free_hand(
    const std::shared_ptr<const Character>& character, const WoundTarget& target,
    const PlanTiming& timing, double length);

}  // namespace sunder
