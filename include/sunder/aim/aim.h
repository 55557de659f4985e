#pragma once

#include <sunder/operation/aimed_operation.h>
#include <sunder/tear/torn_model.h>

#include <cstdint>
#include <string_view>
#include <vector>

namespace sunder {

/// Turns an operation that names bones into a plain one, in the same pose. It is aimed at the model
/// as it is torn so far, so a later operation is resolved after the earlier ones were applied.
/// docs/aim.md describes the method and its limits.
///
/// @return a TearOperation, CutOperation or DrillOperation; not_found for an unknown bone, clip or
///         mesh, for a bone that moves nothing, and where the limb has no surface of its own;
///         invalid_argument for a length, share or direction outside its range;
///         index_out_of_range for a triangle; the failures of make_pose(); limit_exceeded: out of
///         memory. O(size of the model), allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<Operation> resolve(const TornModel& model,
                                                   const AimedOperation& operation);

/// The same operation at the nearest share of its bone at which it can be resolved: its own, or one
/// of twenty beside it. A sever must take off most of the whole limb, not only of what lies beyond
/// the cut.
/// @return the failure at its own share if there is no such share. Takes up to 21 times as long as
///         resolve().
[[nodiscard]] SUNDER_API Result<AimedOperation> at_nearest_share(const TornModel& model,
                                                                 const AimedOperation& operation);

/// The way a character faces at rest, level, unit length.
struct Facing {
  Vec3d direction = Vec3d(0.0, 0.0, 1.0);
  bool is_certain = false;
};

/// Tells the front from pairs of bones whose names differ in left and right, or whose places mirror
/// each other; where no name tells the side, from the feet. Certain if at least two pairs agree and
/// the feet do not point to the back; without pairs it is +z, as a glTF file has it.
///
/// O(vertices x pairs of feet + bones squared).
///
/// @return the failures of rest_pose().
[[nodiscard]] SUNDER_API Result<Facing> find_facing(const Character& character);

/// The operation with its side, or the one from which it is seen without any, as a direction in
/// model space for a character that faces `front`.
/// @param front  level, unit length.
/// @return not_found and invalid_argument as resolve() for the bone and the pose.
[[nodiscard]] SUNDER_API Result<AimedOperation> seen_by(const TornModel& model,
                                                        const AimedOperation& operation,
                                                        const Vec3d& front);

/// What a sever takes off, in the model before it.
struct SeveredPieces {
  std::vector<PiecePlace> severed;  ///< On each connected piece beyond the cut.
  /// On each separate part that mostly moves with the limb: hats, beards, eyes, axes.
  std::vector<PiecePlace> props;
};

/// Finds what comes off when the sever is resolved and applied, for detach(): the places are on the
/// pieces also after the cut. Where a cap joins two pieces, both places are on one; the second is
/// on none once that has come off. Near the joint of the bone all props go along; further out those
/// that lie beyond the cut or move with the bones below.
/// @return as resolve().
[[nodiscard]] SUNDER_API Result<SeveredPieces> severed_pieces(const TornModel& model,
                                                              const SeverOperation& sever);

/// The connected pieces that a limb is made of. detach() takes them off without a cut.
struct LimbPieces {
  std::vector<PiecePlace> places;  ///< On each.
  /// Whether the bone itself moves nothing and the pieces are rigid parts below it: a head of
  /// cubes, where a cut takes off no more than a slice of one.
  bool are_rigid_parts = false;
};

/// Finds the pieces of a limb that shares no surface with the rest of the model: those of which it
/// moves nine tenths or more of the area.
/// @param sever  whose pose and bone count.
/// @return not_found for an unknown bone, if these hold less than nine tenths of what the limb
///         moves, and if nothing would be left; the failures of make_pose(). O(size of the model),
///         allocates. Reentrant.
[[nodiscard]] SUNDER_API Result<LimbPieces> limb_pieces(const TornModel& model,
                                                        const SeverOperation& sever);

/// The bone with a name or, if there is none, the only one with that name behind a namespace or
/// prefix that ends with ':' or '|'.
/// @return not_found, with the names most like it; invalid_argument if several bones have the name
///         behind a prefix.
[[nodiscard]] SUNDER_API Result<std::uint32_t> find_bone(const Skeleton& skeleton,
                                                         std::string_view name);

}  // namespace sunder
