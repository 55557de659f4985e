#pragma once

#include <sunder/core/character.h>

#include <string>

namespace sunder::test {

/// Each triangle divided into four at the midpoints of its edges, weights and morphs interpolated.
/// Normals, tangents, colours and custom attributes are dropped.
Character subdivided(const Character& character);

/// The vertices in each cell of a grid of `cells` along the longest side of the model's box become
/// one, with the mean of their places and weights; triangles without three vertices vanish. Only
/// places, weights and triangles are kept.
Character decimated(const Character& character, std::uint32_t cells);

/// Every vertex moved outwards by a share of the diagonal, along the mean normal at its place.
Character offset_shell(const Character& character, double share);

/// All lengths multiplied: places, morphs, bones and their bind matrices.
Character scaled(const Character& character, float factor);

/// The weights of a vertex on the bones of the skeleton, by name of bone.
double weight_of(const Character& character, Index mesh, Index vertex, const std::string& bone);

/// Sum over bones of the difference of weights, bones told apart by name.
double weight_distance(const Character& a, Index mesh_a, Index vertex_a, const Character& b,
                       Index mesh_b, Index vertex_b);

}  // namespace sunder::test
