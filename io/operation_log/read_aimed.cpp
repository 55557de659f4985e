#include "io/operation_log/read_aimed.h"

#include <numbers>
#include <optional>
#include <utility>

#include "io/operation_log/read_operation.h"
#include "io/operation_log/read_pose.h"
#include "io/operation_log/read_weights.h"
#include "operation/internal/field_ranges.h"
#include "operation/internal/view_sides.h"

namespace sunder::operation_log {
namespace {

/// Degrees, because people write these angles.
struct DegreesIn {
  NumberRange range;
  double operator()(const Place& place) const {
    return NumberIn{range}(place)*std::numbers::pi / 180;
  }
};

std::string read_bone(const Place& place) {
  std::string name = read_name(place);
  if (name.empty()) place.malformed("a bone's name must not be empty");
  return name;
}

/// Reads a length in metres, or in widths of the limb.
struct LengthIn {
  NumberRange range;  ///< Of metres.
  AimedLength operator()(const Place& place) const {
    if (place.value.is_number()) return {NumberIn{range}(place), AimedLength::Unit::metres};
    if (!place.value.is_object()) place.expected("metres, or {\"widths\": …}");
    place.check_fields({"widths"});
    return {NumberIn{field::kWidths}(place.at("widths")), AimedLength::Unit::widths};
  }
};

ViewSide read_side(const Place& place) {
  const std::string name = read_name(place);
  for (const NamedSide& known : kViewSides)
    if (name == known.name) return known.side;
  place.malformed("unknown side '" + name +
                  "'; expected front, back, left, right, top, bottom or a direction");
}

View read_view(const Place& place) {
  if (place.value.is_string()) return read_side(place);
  if (place.value.is_array())
    return ViewDirection{read_direction(place, "direction"), ViewDirection::Space::model};
  if (!place.value.is_object()) place.expected("a side or a direction");
  place.check_fields({"bone"});
  return ViewDirection{read_direction(place.at("bone"), "direction"), ViewDirection::Space::bone};
}

template <class Read, class Value>
void read_optional(const Place& place, const char* key, Read read, std::optional<Value>& value) {
  if (place.has(key)) value = read(place.at(key));
}

/// The fields that tears share, but for lengths.
void read_tear_options(const Place& place, TearOptions& options) {
  read_if_given(place, "layers", read_layers, options.layers);
  read_if_given(place, "wall_material", read_material, options.wall_material);
  read_if_given(place, "weights", read_weight_options, options.weights);
}

/// A length of the options of a slash, in metres or in widths of the limb.
void read_slash_length(const Place& place, const NumberRange& range, double& in_metres,
                       std::optional<double>& in_widths) {
  if (!place.has(range.field)) return;
  const Place field = place.at(range.field);
  if (!field.value.is_object()) {
    if (!field.value.is_number()) field.expected("metres, or {\"widths\": …}");
    in_metres = NumberIn{range}(field);
    return;
  }
  field.check_fields({"widths"});
  in_widths = NumberIn{field::kWidthsFromZero}(field.at("widths"));
}

SlashOperation read_slash(const Place& place) {
  place.check_fields({"op", "pose", "around", "at", "from", "length", "turn", "depth", "width",
                      "layers", "wall_depth", "wall_material", "lip_roll", "weights"});
  SlashOperation slash;
  read_if_given(place, "pose", read_pose, slash.pose);
  slash.place.bone = read_bone(place.at("around"));
  read_if_given(place, "at", NumberIn{field::kShare}, slash.place.at);
  read_if_given(place, "from", read_view, slash.from);
  read_if_given(place, "length", LengthIn{field::kLength}, slash.length);
  read_if_given(place, "turn", DegreesIn{field::kTurnDegrees}, slash.turn);
  read_optional(place, "depth", LengthIn{field::kDepth}, slash.depth);
  read_tear_options(place, slash.options);
  TearOptions& options = slash.options;
  read_slash_length(place, field::kWidth, options.width, slash.in_widths.width);
  read_slash_length(place, field::kWallDepth, options.wall_depth, slash.in_widths.wall_depth);
  read_slash_length(place, field::kLipRoll, options.lip_roll, slash.in_widths.lip_roll);
  return slash;
}

SeverOperation read_sever(const Place& place) {
  place.check_fields(
      {"op", "pose", "bone", "at", "tilt", "from", "caps", "cap_material", "weights"});
  SeverOperation sever;
  read_if_given(place, "pose", read_pose, sever.pose);
  sever.place.bone = read_bone(place.at("bone"));
  read_if_given(place, "at", NumberIn{field::kShare}, sever.place.at);
  read_if_given(place, "tilt", DegreesIn{field::kTiltDegrees}, sever.tilt);
  if (place.has("from") && !place.has("tilt"))
    place.at("from").malformed("without a tilt the direction has no meaning");
  read_if_given(place, "from", read_view, sever.from);
  read_if_given(place, "caps", read_bool, sever.caps);
  read_if_given(place, "cap_material", read_material, sever.cap_material);
  read_if_given(place, "weights", read_weight_options, sever.weights);
  return sever;
}

PunctureOperation read_puncture(const Place& place) {
  place.check_fields({"op", "pose", "around", "at", "from", "radius", "through", "depth",
                      "chord_tolerance", "wall", "wall_material", "weights"});
  PunctureOperation puncture;
  read_if_given(place, "pose", read_pose, puncture.pose);
  puncture.place.bone = read_bone(place.at("around"));
  read_if_given(place, "at", NumberIn{field::kShare}, puncture.place.at);
  read_if_given(place, "from", read_view, puncture.from);
  read_if_given(place, "radius", LengthIn{field::kRadius}, puncture.radius);
  read_if_given(place, "through", read_bool, puncture.is_through);
  read_optional(place, "depth", LengthIn{field::kDepth}, puncture.depth);
  if (puncture.is_through && puncture.depth)
    place.at("depth").malformed("a puncture through the limb has no depth of its own");
  read_if_given(place, "chord_tolerance", NumberIn{field::length_from_zero("chord_tolerance")},
                puncture.chord_tolerance);
  read_if_given(place, "wall", read_bool, puncture.wall);
  read_if_given(place, "wall_material", read_material, puncture.wall_material);
  read_if_given(place, "weights", read_weight_options, puncture.weights);
  return puncture;
}

SurfacePlace read_surface_place(const Place& place) {
  place.check_fields({"mesh", "triangle", "barycentrics"});
  SurfacePlace read;
  const Place mesh = place.at("mesh");
  if (mesh.value.is_string())
    read.mesh = read_name(mesh);
  else
    read.mesh = read_integer(mesh, "the mesh's name or index");
  read.triangle = read_integer(place.at("triangle"), "the triangle's index");
  const Place barycentrics = place.at("barycentrics");
  read_numbers(barycentrics, read.barycentrics);
  double sum = 0;
  for (const double part : read.barycentrics) {
    if (part < 0) barycentrics.malformed("negative");
    sum += part;
  }
  if (!(sum > 0)) barycentrics.malformed("all are zero");
  return read;
}

IncisionOperation read_incision(const Place& place) {
  place.check_fields({"op", "pose", "points", "depth", "width", "layers", "wall_depth",
                      "wall_material", "lip_roll", "weights"});
  IncisionOperation incision;
  read_if_given(place, "pose", read_pose, incision.pose);
  const Place points = place.at("points");
  const std::size_t count = read_array(points, "an array of places").size();
  if (count < 2) points.malformed("an incision needs at least two points");
  for (std::size_t i = 0; i < count; ++i)
    incision.points.push_back(read_surface_place(points.at(i)));
  read_if_given(place, "depth", NumberIn{field::kDepth}, incision.depth);
  read_tear_options(place, incision.options);
  read_if_given(place, "width", NumberIn{field::kWidth}, incision.options.width);
  read_if_given(place, "wall_depth", NumberIn{field::kWallDepth}, incision.options.wall_depth);
  read_if_given(place, "lip_roll", NumberIn{field::kLipRoll}, incision.options.lip_roll);
  return incision;
}

}  // namespace

bool is_aimed(const std::string& name) {
  return name == "slash" || name == "sever" || name == "puncture" || name == "incision";
}

AimedOperation read_aimed(const Place& place, const std::string& name) {
  if (name == "slash") return read_slash(place);
  if (name == "sever") return read_sever(place);
  if (name == "puncture") return read_puncture(place);
  return read_incision(place);
}

}  // namespace sunder::operation_log
