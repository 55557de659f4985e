#pragma once

#include <sunder/operation/aimed_operation.h>

#include "core/operation/internal/describe_operations.h"

// The operations that name bones instead of coordinates.

namespace sunder {

template <class V>
void describe_place(V& v, const char* bone, Is<LimbPlace> auto& of) {
  v({bone, "The bone's name. Without its namespace, if that is unique.", Use::required}, of.bone,
    Name{});
  v({"at", "Share of the bone's length, from 0 at its joint to 1."}, of.at, field::kShare);
}

inline constexpr Field kFrom = {"from", "Where the viewer stands:", Use::if_set,
                                "`\"front\"`; `\"left\"` if the bone points to the front or the "
                                "back"};
inline constexpr Field kAimedDepth = {"depth", "Below the near surface, as `length`.", Use::if_set,
                                      "to the middle of the limb"};

template <class V>
void describe(V& v, Is<SlashOperation> auto& of) {
  v({"pose", "The pose in which the model is torn."}, of.pose);
  describe_place(v, "around", of.place);
  v(kFrom, of.from);
  v({"length", "A number of metres, or `{\"widths\": 0.8}`: in widths of the limb, as seen there."},
    of.length, field::length_above_zero());
  v({"turn", "Degrees, counter-clockwise as seen. 0: across the limb."}, of.turn,
    Degrees{field::kTurnDegrees});
  v(kAimedDepth, of.depth, field::length_above_zero());
  describe_options(v, of.options, &of.in_widths);
}

template <class V>
void describe(V& v, Is<SeverOperation> auto& of) {
  v({"pose", "The pose in which the model is cut."}, of.pose);
  describe_place(v, "bone", of.place);
  v({"tilt", "Degrees, by which the normal of the plane leans from the bone towards `from`."},
    of.tilt, Degrees{field::kTiltDegrees});
  v(kFrom, of.from);
  v({"caps", "As in `cut`."}, of.caps);
  v({"cap_material", "As in `cut`.", Use::if_set, "as there"}, of.cap_material, Material{});
  describe_own_weights(v, of.weights);
}

template <class V>
void describe(V& v, Is<PunctureOperation> auto& of) {
  v({"pose", "The pose in which the model is drilled."}, of.pose);
  describe_place(v, "around", of.place);
  v(kFrom, of.from);
  v({"radius", "As `length`."}, of.radius, field::length_above_zero());
  v({"through", "Whether the bore leaves the limb at its back."}, of.is_through);
  Field depth = kAimedDepth;
  if (of.is_through) depth.refusal = "a puncture through the limb has no depth of its own";
  v(depth, of.depth, field::length_above_zero());
  v({"chord_tolerance", "As in `drill`."}, of.chord_tolerance, field::length_from_zero());
  v({"wall", "As in `drill`."}, of.wall);
  v({"wall_material", "As in `drill`.", Use::if_set, "as there"}, of.wall_material, Material{});
  describe_own_weights(v, of.weights);
}

template <class V>
void describe(V& v, Is<SurfacePlace> auto& of) {
  v({"mesh", "Its name or index.", Use::required}, of.mesh, Name{true});
  v({"triangle", "In the model as it is torn so far.", Use::required}, of.triangle,
    Integer{"the triangle's index"});
  v({"barycentrics", "Not negative; they are divided by their sum.", Use::required},
    of.barycentrics);
}

template <class V>
void describe(V& v, Is<IncisionOperation> auto& of) {
  v({"pose", "The pose in which the model is torn."}, of.pose);
  v({"points", "At least two places, each in a triangle of a mesh", Use::required}, of.points,
    List{"places", 2, "an incision needs at least two points"});
  v({"depth", "Below the surface, metres."}, of.depth, field::length_above_zero());
  describe(v, of.options);
}

}  // namespace sunder
