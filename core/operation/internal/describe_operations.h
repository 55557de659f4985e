#pragma once

#include <sunder/operation/aimed_operation.h>

#include "core/operation/internal/describe_weights.h"

// The plain operations.

namespace sunder {

/// The `weights` of an operation that creates vertices.
template <class V>
void describe_own_weights(V& v, auto& weights) {
  v({"weights", "How the vertices it creates are skinned", Use::if_set, "the model's"}, weights);
}

/// @param in_widths  of a slash; null: lengths are in metres only.
template <class V>
void describe_options(V& v, Is<TearOptions> auto& of,
                      Is<SlashOperation::InWidths> auto* in_widths) {
  const auto widths = [&](auto member) { return in_widths ? &(in_widths->*member) : nullptr; };
  using InWidths = SlashOperation::InWidths;
  v({"width", "Width of the gap. 0: the lips coincide and no surface is lost."}, of.width,
    TearLength{field::length_from_zero(), widths(&InWidths::width)});
  v({"layers", "The surfaces that are torn:"}, of.layers);
  v({"wall_depth", "Depth of the inner walls that the lips get. 0: none."}, of.wall_depth,
    TearLength{field::length_from_zero(), widths(&InWidths::wall_depth), true});
  v({"lip_roll", "Radius of the rims with which walls begin: lips rolled outwards.", Use::if_set},
    of.lip_roll, TearLength{field::length_from_zero(), widths(&InWidths::lip_roll)});
  v({"wall_material", "Material of the walls", Use::if_set, "that of the lips"}, of.wall_material,
    Material{});
  describe_own_weights(v, of.weights);
}
template <class V>
void describe(V& v, Is<TearOptions> auto& of) {
  describe_options(v, of, static_cast<const SlashOperation::InWidths*>(nullptr));
}

template <class V>
void describe(V& v, Is<TearOperation> auto& of) {
  v({"pose", "The pose in which the model is torn."}, of.pose);
  describe(v, of.options);
  v({"stroke", "At least two blades. Every two consecutive blades sweep one segment.",
     Use::required},
    of.stroke, Blades{&of.pose_changes});
}

template <class V>
void describe(V& v, Is<Blade> auto& of) {
  v({"base", "Outside the surface.", Use::required}, of.base, Point{});
  v({"tip", "How deep the blade reaches.", Use::required}, of.tip, Point{});
}

template <class V>
void describe(V& v, Is<SectionRay> auto& of) {
  v({"origin", "Where the ray begins.", Use::required}, of.origin, Point{});
  v({"direction", "Of any length except zero.", Use::required}, of.direction,
    Direction{"direction"});
}

template <class V>
void describe(V& v, Is<PlaneCut> auto& of) {
  v.object({"plane", "A `point` on it and its `normal`, of any length except zero.", Use::required},
           [&](auto& in) {
             in({"point", "On the plane.", Use::required}, of.point, Point{});
             in({"normal", "Towards the left lip.", Use::required}, of.normal, Direction{"normal"});
           });
  v({"bounds", "At least three corners of a convex polygon, outside of which nothing is cut.",
     Use::if_set, "the whole plane"},
    of.bounds, List{"points", 3, "bounds need at least three corners"});
  v({"caps", "Whether the sections that the cut opens are closed, if they are closed loops."},
    of.caps);
  v({"cap_material", "Material of the caps", Use::if_set, "that of the rim"}, of.cap_material,
    Material{});
  v({"sections", "At least one place. Only the section nearest to each of them is cut", Use::if_set,
     "all sections"},
    of.sections, List{"points", 1, "sections need at least one place; without them all are cut"});
  v({"first_hit", "A ray. Only the section is cut that it, projected onto the plane, meets first.",
     Use::if_set, "all sections"},
    of.first_hit);
  v({"bone",
     "Name of a bone. Only sections are cut that this bone and those below it move by more than "
     "half",
     Use::if_set, "any"},
    of.bone, Name{});
  describe_own_weights(v, of.weights);
}
template <class V>
void describe(V& v, Is<CutOperation> auto& of) {
  v({"pose", "The pose in which the model is cut."}, of.pose);
  describe(v, of.cut);
}

template <class V>
void describe(V& v, Is<Bore> auto& of) {
  v.object({"axis", "Its `origin`, outside the surface, and its `direction`", Use::required},
           [&](auto& in) {
             in({"origin", "Outside the surface.", Use::required}, of.origin, Point{});
             in({"direction", "Of any length except zero.", Use::required}, of.direction,
                Direction{"direction"});
           });
  v({"radius", "Above 0.", Use::required}, of.radius, field::length_above_zero());
  v({"depth", "From the origin along the axis, above 0.", Use::required}, of.depth,
    field::length_above_zero());
  v({"chord_tolerance",
     "Largest distance of the rim from the circle. 0: one per cent of the radius."},
    of.chord_tolerance, ChordTolerance{of.radius});
  v({"wall", "Whether the bore is lined."}, of.wall);
  v({"wall_material", "Material of the wall", Use::if_set, "that of the rim"}, of.wall_material,
    Material{});
  describe_own_weights(v, of.weights);
}
template <class V>
void describe(V& v, Is<DrillOperation> auto& of) {
  v({"pose", "The pose in which the model is drilled."}, of.pose);
  describe(v, of.bore);
}

template <class V>
void describe(V& v, Is<PieceOfTriangle> auto& of) {
  v({"mesh", "Index of the mesh."}, of.mesh, Integer{"a mesh"});
  v({"triangle", "A triangle of the piece, in the model as it is torn by then.", Use::required},
    of.triangle, Integer{"a triangle"});
}
template <class V>
void describe(V& v, Is<PieceNear> auto& of) {
  v({"near", "The piece whose surface is nearest to this place.", Use::required}, of.point,
    Point{});
  v({"bone", "Only triangles that this bone moves most count.", Use::if_set, "any"}, of.bone,
    Name{true});
}
template <class V>
void describe(V& v, Is<DetachOperation> auto& of) {
  v({"pose", "The pose in which `near` is measured, and in which a frozen piece stands."}, of.pose);
  v({"piece", "The piece near a place, or the one with a triangle", Use::required}, of.piece);
}

template <class V>
void describe(V& v, Is<Weld> auto& of) {
  v({"places", "At least one place. Only the wound nearest to each of them is closed", Use::if_set,
     "all wounds"},
    of.places, List{"points", 1, "places need at least one; without them all wounds are closed"});
  v({"reach", "How far from those places along the wound. 0: to its ends.", Use::if_set}, of.reach,
    field::length_from_zero());
}
template <class V>
void describe(V& v, Is<WeldOperation> auto& of) {
  v({"pose", "The pose in which places and lengths are measured."}, of.pose);
  describe(v, of.weld);
}

template <class V>
void describe(V& v, Is<Suture> auto& of) {
  v({"places", "At least one place. Only the wound nearest to each of them is sewn", Use::if_set,
     "all wounds"},
    of.places, List{"points", 1, "places need at least one; without them all wounds are sewn"});
  v({"reach", "How far from those places along the wound. 0: to its ends.", Use::if_set}, of.reach,
    field::length_from_zero());
  v({"spacing", "Distance between threads along the wound, above 0."}, of.spacing,
    field::length_above_zero());
  v({"stiffness", "Of a thread, newtons per metre, above 0."}, of.stiffness, field::kStiffness);
  v({"tension", "With which a thread was tied, newtons.", Use::if_set}, of.tension,
    field::kNewtons);
  v({"strength", "Newtons at which a thread breaks. 0: it never does.", Use::if_set}, of.strength,
    field::kNewtons);
}
template <class V>
void describe(V& v, Is<SutureOperation> auto& of) {
  v({"pose", "The pose in which places and lengths are measured."}, of.pose);
  describe(v, of.suture);
}

template <class V>
void describe(V& v, Is<WeightsOperation> auto& of) {
  v({"first", "Index of the first operation, counted from 0 over those not undone."},
    of.first_operation, Integer{"an operation's index"});
  v({"count", "Number of operations, at least 1.", Use::if_set, "all"}, of.operation_count,
    Integer{"how many operations", 1});
  v({"weights", "How their points are weighted", Use::required}, of.weights);
  const auto only_with = [&](WeightPolicy policy, const char* refusal) {
    return of.weights.policy == policy ? nullptr : refusal;
  };
  v({.name = "pose",
     .text = "The pose that `pose_exact` meets. Only with that policy.",
     .refusal = only_with(WeightPolicy::pose_exact, "only the policy 'pose_exact' uses a pose")},
    of.pose);
  v({.name = "refit",
     .text = "How `refit` fits. Only with that policy.",
     .refusal = only_with(WeightPolicy::refit, "only the policy 'refit' has options of a fit")},
    of.refit);
}

template <class V, class T>
requires Is<T, UndoOperation> || Is<T, RedoOperation>
void describe(V& v, T& of) {
  v({"count", "An integer, at least 1."}, of.count, Integer{"how many operations", 1});
}

}  // namespace sunder
