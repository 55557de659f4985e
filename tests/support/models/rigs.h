#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>

#include "support/machine/random.h"

namespace sunder::test {

/// A flat sheet in the plane z = 0, from (0, 0) to (size, size), normals +z, cells x cells squares
/// of two triangles, two bones along x with blended weights.
Character make_sheet(std::uint32_t cells, float size = 1.0f);

/// A blade that crosses that sheet downwards, from half a metre above it to half a metre below it.
Blade down_at(double x, double y);

/// A closed tube along y with a UV seam, hard-edged caps in a second submesh, `bone_count` bones in
/// a chain, up to four smooth influences per vertex, a morph target and a bending clip "Bend" of 2
/// s.
Character make_tube(std::uint32_t rings, std::uint32_t sides, std::uint32_t bone_count);

/// A closed ball with bumps, of about `points` evenly but irregularly distributed points, rigged by
/// rig_along().
Character make_bumpy_ball(std::uint32_t points);

/// Replaces skeleton, skins and weights by `bone_count` bones in a chain along the longest axis, up
/// to four smooth influences per vertex.
void rig_along(Character& character, std::uint32_t bone_count);

/// Two such tubes, each with its own mesh and skin on three bones; in bind space the upper one
/// stands on the lower one's cap.
Character make_two_tubes(std::uint32_t rings, std::uint32_t sides);

/// Lets all vertices of a mesh follow one slot of its skin.
void attach_to(Mesh& mesh, std::uint32_t slot);

/// A trunk and a head of rigid parts, as programs for blocks write them: the bone "head" moves
/// nothing, its part, which stands 5 cm above the trunk, hangs on a bone "cube" elsewhere.
Character make_block_figure();

/// A triangle soup: random triangles on a coarse grid, with edges of many faces, duplicate and
/// flipped faces, faces without area, unused vertices.
Character make_soup(Random& random);

/// Every bone rotated by up to `angle` and scaled by up to `scale` (1: no scale) relative to rest;
/// morph weights in [0, 1].
ModelPose random_pose(const Character& character, Random& random, double angle = 0.6,
                      double scale = 1.2);

/// A stroke that follows the posed surface from a random place, over `length` x the model's
/// diagonal in `segments` segments; blades are parallel to the face's normal and reach slightly
/// below it.
Stroke random_stroke(const Character& character, const ModelPose& pose, Random& random,
                     double length = 0.2, std::uint32_t segments = 3);

/// Posed positions by the double-precision reference.
std::vector<Vec3d> posed_positions(const Character& character, std::uint32_t mesh,
                                   const ModelPose& pose);

/// The volume that a closed surface encloses, by the divergence theorem; negative if its faces look
/// inwards.
double enclosed_volume(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles);

/// Diagonal of the box around all meshes in a pose.
double posed_diagonal(const Character& character, const ModelPose& pose);

}  // namespace sunder::test
