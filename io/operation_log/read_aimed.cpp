#include "io/operation_log/read_aimed.h"

#include <numbers>
#include <optional>
#include <utility>

#include "io/operation_log/read_operation.h"
#include "io/operation_log/read_pose.h"
#include "io/operation_log/read_weights.h"
#include "operation/internal/view_sides.h"

namespace sunder::operation_log {
namespace {

/// Degrees, because people write these angles.
double read_degrees(const Place& place) { return read_number(place) * std::numbers::pi / 180; }

double read_share(const Place& place) {
  const double share = read_number(place);
  if (share < 0 || share > 1) place.malformed("expected a share from 0 to 1");
  return share;
}

std::string read_bone(const Place& place) {
  std::string name = read_name(place);
  if (name.empty()) place.malformed("a bone's name must not be empty");
  return name;
}

AimedLength read_length(const Place& place) {
  if (place.value.is_number()) return {read_number_above_zero(place), AimedLength::Unit::metres};
  if (!place.value.is_object()) place.expected("metres, or {\"widths\": …}");
  place.check_fields({"widths"});
  return {read_number_above_zero(place.at("widths")), AimedLength::Unit::widths};
}

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

/// The fields that tears share.
void read_tear_options(const Place& place, TearOptions& options) {
  read_if_given(place, "width", read_number_at_least_zero, options.width);
  read_if_given(place, "layers", read_layers, options.layers);
  read_if_given(place, "wall_depth", read_number_at_least_zero, options.wall_depth);
  read_if_given(place, "wall_material", read_material, options.wall_material);
  read_if_given(place, "lip_roll", read_number_at_least_zero, options.lip_roll);
  read_if_given(place, "weights", read_weight_options, options.weights);
}

SlashOperation read_slash(const Place& place) {
  place.check_fields({"op", "pose", "around", "at", "from", "length", "turn", "depth", "width",
                      "layers", "wall_depth", "wall_material", "lip_roll", "weights"});
  SlashOperation slash;
  read_if_given(place, "pose", read_pose, slash.pose);
  slash.place.bone = read_bone(place.at("around"));
  read_if_given(place, "at", read_share, slash.place.at);
  read_if_given(place, "from", read_view, slash.from);
  read_if_given(place, "length", read_length, slash.length);
  read_if_given(place, "turn", read_degrees, slash.turn);
  read_optional(place, "depth", read_length, slash.depth);
  read_tear_options(place, slash.options);
  return slash;
}

SeverOperation read_sever(const Place& place) {
  place.check_fields(
      {"op", "pose", "bone", "at", "tilt", "from", "caps", "cap_material", "weights"});
  SeverOperation sever;
  read_if_given(place, "pose", read_pose, sever.pose);
  sever.place.bone = read_bone(place.at("bone"));
  read_if_given(place, "at", read_share, sever.place.at);
  read_if_given(place, "tilt", read_degrees, sever.tilt);
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
  read_if_given(place, "at", read_share, puncture.place.at);
  read_if_given(place, "from", read_view, puncture.from);
  read_if_given(place, "radius", read_length, puncture.radius);
  read_if_given(place, "through", read_bool, puncture.is_through);
  read_optional(place, "depth", read_length, puncture.depth);
  if (puncture.is_through && puncture.depth)
    place.at("depth").malformed("a puncture through the limb has no depth of its own");
  read_if_given(place, "chord_tolerance", read_number_at_least_zero, puncture.chord_tolerance);
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
  read_if_given(place, "depth", read_number_above_zero, incision.depth);
  read_tear_options(place, incision.options);
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
