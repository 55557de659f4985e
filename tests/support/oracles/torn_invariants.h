#pragma once

#include <sunder/tear/torn_model.h>

#include <string>
#include <vector>

namespace sunder::test {

/// Invariants of a torn model after any operation (docs/architecture.md). Each function returns the
/// violations, one sentence per fault. All are computed from the arrays alone, not from the
/// kernel's own data.

/// Indices, weights, finite values; vertices of the source are bit-identical; the parts of each
/// source triangle cover it exactly, or at most if some of them are retired, and none has zero
/// area. The same for walls and caps as created; these have vertices and submeshes of their own.
std::vector<std::string> broken_laws(const TornModel& model);

/// Edges are no less manifold than the source's, and the number of points with a face equals the
/// kernel's. For sources that do not touch or overlap themselves: if two sheets coincide, the
/// points that a tear creates on both cannot be told apart.
std::vector<std::string> broken_surface(const TornModel& model);

/// Whether no two surface points coincide, no two faces have the same points and no edge has more
/// than two faces, as broken_surface() requires.
bool is_clear_of_itself(const Character& source);

/// No T-junctions: with the lips closed (tear sides ignored) the surface has the borders and
/// components of the source. For models whose tears do not meet one another or themselves: there
/// one lip has a point that the other has not.
std::vector<std::string> broken_closure(const TornModel& model);

/// Lips: pairs coincide in position and weights, bit for bit, differ in tear side, and no other
/// separate points coincide unmarked.
std::vector<std::string> broken_lips(const TornModel& model, const ChangeRecord& change);

/// In `pose`, every new vertex of the surface is where the closed form of the interpolation error
/// puts it: the barycentric position on the untorn posed triangle minus sum_{k<l} beta_k beta_l
/// sum_i (w_k,i - w_l,i) R_i (v_k - v_l), within rounding.
std::vector<std::string> broken_closed_form(const TornModel& model, const ModelPose& pose);

}  // namespace sunder::test
