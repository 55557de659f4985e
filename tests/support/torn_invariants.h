#pragma once

#include <sunder/tear/torn_model.h>

#include <string>
#include <vector>

namespace sunder::test {

/// The laws that a torn model must keep, whatever tore it (docs/architecture.md). Each returns what
/// is broken, one sentence a fault; empty: nothing. All are computed from the arrays alone, not
/// from the kernel's own bookkeeping.

/// Indices, weights, finite values; vertices of the source bit-identical; parts of each source
/// triangle cover it exactly, or at most where some of them are retired, none without area. The
/// same for walls and caps, as they were made; they have vertices and submeshes of their own.
std::vector<std::string> broken_laws(const TornModel& model);

/// Edges no less manifold than the source's; as many points with a face as the kernel has. For
/// sources that do not touch or overlap themselves: where two sheets lie on one another, what a
/// tear makes on both is told apart by nothing.
std::vector<std::string> broken_surface(const TornModel& model);

/// Whether no two surface points share a place and no edge has more than two faces: what
/// broken_surface() asks for.
bool is_clear_of_itself(const Character& source);

/// No T-junction: with the lips closed (tear sides ignored) the surface has the borders and pieces
/// of the source. For models whose tears do not meet one another or themselves: there one lip has a
/// point that the other has not.
std::vector<std::string> broken_closure(const TornModel& model);

/// Lips: pairs coincide in position and weights, bit for bit, differ in tear side, and no other
/// separate points coincide unmarked.
std::vector<std::string> broken_lips(const TornModel& model, const ChangeRecord& change);

/// In `pose`, every new vertex of the surface stands where the closed form of the interpolation
/// error says: barycentric place on the untorn posed triangle minus sum_{k<l} beta_k beta_l sum_i
/// (w_k,i - w_l,i) R_i (v_k - v_l), within rounding.
std::vector<std::string> broken_closed_form(const TornModel& model, const ModelPose& pose);

}  // namespace sunder::test
