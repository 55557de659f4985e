#pragma once

#include "pipeline/validation/checks/finding_list.h"
#include "pipeline/validation/checks/pose_batches.h"
#include "pipeline/validation/checks/skin_points.h"

namespace sunder::validation {

/// Two vertices at one place that have other weights, or a vertex on the inside of an edge: what
/// opens in a pose.
struct Crack {
  Index vertex = 0;                ///< In the surface, all meshes one after the other.
  std::array<Index, 2> ends = {};  ///< Vertices; twice the same one for copies.
  double t = 0.0;                  ///< Place between the ends.
};

/// Cracks as terms of the source's skeleton.
struct CrackRows {
  std::vector<Index> vertices;  ///< Of the target's surface, one per row.
  SkinDifferences rows;
};

/// Copies of one point (and the lips of a tear at one place) with different weights.
[[nodiscard]] std::vector<Crack> find_unequal_copies(const Skinned& skin);
/// Border vertices on the inside of border edges of the same part of the surface.
[[nodiscard]] std::vector<Crack> find_t_junctions(const Skinned& skin);
/// Vertices of edges that are two lips on `reference` and one inner edge on `target`.
[[nodiscard]] Places find_welded_lips(const Skinned& reference, const Skinned& target);

/// The cracks of the target as terms of the source's skeleton, one row per crack.
[[nodiscard]] SkinDifferences rows_of_cracks(const RowReader& reader, const SkinPoints& points,
                                             std::span<const Crack> cracks);
/// Both searches on target and source: what opens, how wide over the poses. Cracks that the source
/// has at the same place are inherited.
/// @return all of them as terms, for a certificate.
[[nodiscard]] CrackRows check_cracks(const RowReader& reader, const SkinPoints& points,
                                     std::span<const PoseBatch> batches, FindingList& findings);

}  // namespace sunder::validation
