#include "io/operation_log/read_operation.h"

#include <string>
#include <utility>

#include "io/operation_log/read_aimed.h"
#include "io/operation_log/read_pose.h"
#include "io/operation_log/read_weights.h"
#include "operation/internal/field_ranges.h"

namespace sunder::operation_log {
namespace {

/// Of a log: an operation takes up to a hundred times the memory of its text.
constexpr std::size_t kMaximumOperations = 1'000'000;

void read_stroke(const Place& place, TearOperation& tear) {
  const std::size_t count = read_array(place, "an array of blades").size();
  if (count < 2) place.malformed("a stroke needs at least two blades");
  tear.stroke.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Place blade = place.at(i);
    blade.check_fields({"base", "tip", "pose"});
    tear.stroke.push_back({read_point(blade.at("base")), read_point(blade.at("tip"))});
    if (tear.stroke.back().base == tear.stroke.back().tip)
      blade.malformed("base and tip of a blade must differ");
    if (!blade.has("pose")) continue;
    if (i == 0)
      blade.at("pose").malformed(
          "the first blade cannot have a pose; give it as the operation's 'pose'");
    tear.pose_changes.push_back({i, read_pose(blade.at("pose"))});
  }
}

TearOperation read_tear(const Place& place) {
  place.check_fields({"op", "pose", "width", "layers", "wall_depth", "wall_material", "lip_roll",
                      "weights", "stroke"});
  TearOperation tear;
  read_if_given(place, "pose", read_pose, tear.pose);
  read_if_given(place, "width", NumberIn{field::kWidth}, tear.options.width);
  read_if_given(place, "layers", read_layers, tear.options.layers);
  read_if_given(place, "wall_depth", NumberIn{field::kWallDepth}, tear.options.wall_depth);
  read_if_given(place, "wall_material", read_material, tear.options.wall_material);
  read_if_given(place, "lip_roll", NumberIn{field::kLipRoll}, tear.options.lip_roll);
  read_if_given(place, "weights", read_weight_options, tear.options.weights);
  read_stroke(place.at("stroke"), tear);
  return tear;
}

std::vector<Vec3d> read_bounds(const Place& place) {
  const std::size_t count = read_array(place, "an array of points").size();
  if (count < 3) place.malformed("bounds need at least three corners");
  std::vector<Vec3d> corners;
  corners.reserve(count);
  for (std::size_t i = 0; i < count; ++i) corners.push_back(read_point(place.at(i)));
  return corners;
}

std::vector<Vec3d> read_sections(const Place& place) {
  const std::size_t count = read_array(place, "an array of points").size();
  if (count == 0) place.malformed("sections need at least one place; without them all are cut");
  std::vector<Vec3d> places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i) places.push_back(read_point(place.at(i)));
  return places;
}

std::optional<SectionRay> read_ray(const Place& place) {
  place.check_fields({"origin", "direction"});
  return SectionRay{read_point(place.at("origin")),
                    read_direction(place.at("direction"), "direction")};
}

std::string read_limb(const Place& place) {
  std::string name = read_name(place);
  if (name.empty()) place.malformed("a bone's name must not be empty");
  return name;
}

CutOperation read_cut(const Place& place) {
  place.check_fields({"op", "pose", "plane", "bounds", "caps", "sections", "first_hit", "bone",
                      "weights", "cap_material"});
  CutOperation operation;
  read_if_given(place, "pose", read_pose, operation.pose);
  const Place plane = place.at("plane");
  plane.check_fields({"point", "normal"});
  operation.cut.point = read_point(plane.at("point"));
  operation.cut.normal = read_direction(plane.at("normal"), "normal");
  read_if_given(place, "bounds", read_bounds, operation.cut.bounds);
  read_if_given(place, "caps", read_bool, operation.cut.caps);
  read_if_given(place, "sections", read_sections, operation.cut.sections);
  read_if_given(place, "first_hit", read_ray, operation.cut.first_hit);
  read_if_given(place, "bone", read_limb, operation.cut.bone);
  read_if_given(place, "cap_material", read_material, operation.cut.cap_material);
  read_if_given(place, "weights", read_weight_options, operation.cut.weights);
  return operation;
}

/// Reads the chord tolerance of a bore of that radius.
struct ChordTolerance {
  double radius;
  double operator()(const Place& place) const {
    if (place.value.is_number() && place.value.get<double>() == 0) return 0;
    return NumberIn{field::chord_tolerance(radius)}(place);
  }
};

DrillOperation read_drill(const Place& place) {
  place.check_fields({"op", "pose", "axis", "radius", "depth", "chord_tolerance", "wall",
                      "wall_material", "weights"});
  DrillOperation operation;
  Bore& bore = operation.bore;
  read_if_given(place, "pose", read_pose, operation.pose);
  const Place axis = place.at("axis");
  axis.check_fields({"origin", "direction"});
  bore.origin = read_point(axis.at("origin"));
  bore.direction = read_direction(axis.at("direction"), "direction");
  bore.radius = NumberIn{field::kRadius}(place.at("radius"));
  bore.depth = NumberIn{field::kDepth}(place.at("depth"));
  read_if_given(place, "chord_tolerance", ChordTolerance{bore.radius}, bore.chord_tolerance);
  read_if_given(place, "wall", read_bool, bore.wall);
  read_if_given(place, "wall_material", read_material, bore.wall_material);
  read_if_given(place, "weights", read_weight_options, bore.weights);
  return operation;
}

PiecePlace read_piece(const Place& place) {
  if (!place.value.is_object()) place.expected("an object");
  if (place.has("near")) {
    place.check_fields({"near", "bone"});
    PieceNear piece{read_point(place.at("near"))};
    read_if_given(place, "bone", read_name, piece.bone);
    return piece;
  }
  place.check_fields({"mesh", "triangle"});
  PieceOfTriangle piece;
  if (place.has("mesh")) piece.mesh = read_integer(place.at("mesh"), "a mesh");
  piece.triangle = read_integer(place.at("triangle"), "a triangle");
  return piece;
}

DetachOperation read_detach(const Place& place) {
  place.check_fields({"op", "pose", "piece"});
  DetachOperation operation;
  read_if_given(place, "pose", read_pose, operation.pose);
  operation.piece = read_piece(place.at("piece"));
  return operation;
}

template <class UndoOrRedo>
UndoOrRedo read_steps(const Place& place) {
  place.check_fields({"op", "count"});
  UndoOrRedo operation;
  read_if_given(place, "count", read_operation_count, operation.count);
  return operation;
}

std::string read_kind(const Place& place) {
  if (!place.value.is_object()) place.expected("an object");
  return read_name(place.at("op"));
}

Operation read_operation(const Place& place) {
  const std::string name = read_kind(place);
  if (name == "tear") return read_tear(place);
  if (name == "cut") return read_cut(place);
  if (name == "drill") return read_drill(place);
  if (name == "weights") return read_weights(place);
  if (name == "detach") return read_detach(place);
  if (name == "undo") return read_steps<UndoOperation>(place);
  if (name == "redo") return read_steps<RedoOperation>(place);
  if (is_aimed(name))
    place.at("op").fail(
        StatusCode::unsupported_feature,
        "'" + name + "' needs a model to be resolved; only plain operations are read here");
  place.at("op").fail(
      StatusCode::unsupported_feature,
      "unknown operation '" + name + "'; expected tear, cut, drill, detach, weights, undo or redo");
}

LoggedOperation read_logged_operation(const Place& place) {
  const std::string name = read_kind(place);
  if (is_aimed(name)) return read_aimed(place, name);
  return read_operation(place);
}

/// Reads all entries of a log. @param read  reads one.
template <class Read>
auto read_entries(const Json& log, const Character* model, Read read) {
  const Place root{log, "", kNone, model};
  if (!log.is_object()) root.expected("an object");
  // The version is checked first, so that a log of another version is reported as such.
  const Place version = root.at("sunder_operations");
  if (!version.value.is_number_integer()) version.expected("the version, an integer");
  if (version.value != 1)
    version.fail(StatusCode::unsupported_feature,
                 "version " + version.value.dump() + "; this build reads version 1");
  root.check_fields({"sunder_operations", "operations"});

  const Place list = root.at("operations");
  std::vector<decltype(read(list))> entries;
  if (const std::size_t count = read_array(list, "an array").size(); count > kMaximumOperations)
    list.fail(StatusCode::limit_exceeded, std::to_string(count) + " operations; the limit is " +
                                              std::to_string(kMaximumOperations));
  entries.reserve(list.value.size());
  for (std::size_t i = 0; i < list.value.size(); ++i) {
    Place one = list.at(i);
    one.operation = static_cast<std::uint32_t>(i);
    entries.push_back(read(one));
  }
  return entries;
}

}  // namespace

Layers read_layers(const Place& place) {
  const std::string name = read_name(place);
  if (name == "all") return Layers::all;
  if (name != "nearest")
    place.fail(StatusCode::unsupported_feature,
               "unknown layers '" + name + "'; expected 'nearest' or 'all'");
  return Layers::nearest;
}

std::vector<Operation> read_log(const Json& log, const Character* model) {
  return read_entries(log, model, read_operation);
}

std::vector<LoggedOperation> read_aimed_log(const Json& log, const Character* model) {
  return read_entries(log, model, read_logged_operation);
}

}  // namespace sunder::operation_log
