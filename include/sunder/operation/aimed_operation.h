#pragma once

#include <sunder/operation/operation.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace sunder {

// Operations that name bones instead of coordinates. resolve() of <sunder/aim/aim.h> turns them
// into plain operations; docs/aim.md describes how.

/// A length in metres, or in widths of the limb where the operation is aimed.
struct AimedLength {
  enum class Unit : std::uint8_t { metres, widths };
  double value = 0.0;  ///< > 0.
  Unit unit = Unit::metres;

  bool operator==(const AimedLength&) const = default;
};

/// From where a limb is seen. The sides are those of the model as it stands in a glTF file: front
/// is +z, top +y, and the model's own left +x.
enum class ViewSide : std::uint8_t { front, back, left, right, top, bottom };

/// A direction from the limb towards the viewer. Its part along the limb does not count.
struct ViewDirection {
  enum class Space : std::uint8_t { model, bone };
  Vec3d direction = Vec3d(0.0, 0.0, 1.0);  ///< Any length except zero.
  Space space = Space::model;

  bool operator==(const ViewDirection&) const = default;
};

using View = std::variant<ViewSide, ViewDirection>;
// Where no view is given, a limb is seen from the front, and from the left if its bone points
// within 30 degrees to the front or the back.

/// A place on a limb.
struct LimbPlace {
  /// The bone's name. A name without its namespace or prefix ("LeftArm" for "mixamorig:LeftArm")
  /// counts if only one bone has it.
  std::string bone = {};
  /// Share of the bone's length: 0 at its joint, 1 at the joint it leads to.
  double at = 0.5;

  bool operator==(const LimbPlace&) const = default;
};

/// A straight stroke on the near side of a limb, `{"op": "slash"}` in a log.
struct SlashOperation {
  PoseSpec pose = {};
  LimbPlace place = {};
  std::optional<View> from = {};
  AimedLength length = {0.6, AimedLength::Unit::widths};
  double turn = 0.0;  ///< Radians about the view, counter-clockwise as seen; 0: across the limb.
  /// Reach of the blade below the near surface. If empty: the middle of the limb.
  std::optional<AimedLength> depth = {};
  TearOptions options = {};
  /// Lengths of `options` in widths of the limb; each takes the place of the one in metres.
  struct InWidths {
    std::optional<double> width = {}, wall_depth = {}, lip_roll = {};

    bool operator==(const InWidths&) const = default;
  };
  InWidths in_widths = {};
};

/// A cut through a limb and nothing else, `{"op": "sever"}` in a log.
struct SeverOperation {
  PoseSpec pose = {};
  LimbPlace place = {{}, 0.0};
  double tilt = 0.0;              ///< Radians, by which the plane's normal leans towards `from`.
  std::optional<View> from = {};  ///< Counts only with a tilt.
  bool caps = true;
  std::optional<WeightOptions> weights = {};
  std::uint32_t cap_material = kNone;  ///< As in PlaneCut.
};

/// A bore into or through a limb, `{"op": "puncture"}` in a log.
struct PunctureOperation {
  PoseSpec pose = {};
  LimbPlace place = {};
  std::optional<View> from = {};
  AimedLength radius = {0.1, AimedLength::Unit::widths};
  bool is_through = false;  ///< Out at the back of the limb.
  /// Below the near surface; not with `is_through`. If empty: the middle of the limb.
  std::optional<AimedLength> depth = {};
  double chord_tolerance = 0.0;  ///< As Bore::chord_tolerance.
  bool wall = false;
  std::optional<WeightOptions> weights = {};
  std::uint32_t wall_material = kNone;  ///< As in Bore.
};

/// A place in a triangle of the model as it is torn so far.
struct SurfacePlace {
  std::variant<std::uint32_t, std::string> mesh = 0u;  ///< By index or by name.
  std::uint32_t triangle = 0;
  std::array<double, 3> barycentrics = {1.0, 0.0, 0.0};  ///< >= 0; divided by their sum.

  bool operator==(const SurfacePlace&) const = default;
};

/// A stroke along the surface through given places, `{"op": "incision"}` in a log.
struct IncisionOperation {
  PoseSpec pose = {};
  std::vector<SurfacePlace> points = {};  ///< At least two.
  double depth = 0.005;                   ///< Reach of the blade below the surface, metres; > 0.
  TearOptions options = {};
};

using AimedOperation =
    std::variant<SlashOperation, SeverOperation, PunctureOperation, IncisionOperation>;

/// An entry of a log that may hold operations of both kinds.
using LoggedOperation = std::variant<Operation, AimedOperation>;

}  // namespace sunder
