#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>
#include <sunder/validation/finding.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// A bone of the target and the bone of the source that it corresponds to, by name.
struct BoneNames {
  std::string target, source;
};

enum class TransferMethod : std::uint8_t {
  /// Every vertex takes the weights of the closest place on the source, interpolated there.
  closest_point,
  /// Only vertices whose match is accepted do; the weights of the others continue them smoothly
  /// over the surface of the target. Source: Abdrashitov, Raichstat, Monsen, Hill, Robust skin
  /// weights transfer via weight inpainting, SIGGRAPH Asia 2023 [abdrashitov2023robust].
  inpainting,
};

struct TransferOptions {
  TransferMethod method = TransferMethod::inpainting;
  double distance =
      0.05;  ///< Largest distance of an accepted match; share of the target's diagonal.
  double angle = 0.52359877559829887;  ///< Largest angle between its normals, radians; 30 degrees.
  bool flip_normals = false;           ///< Whether normals that point the opposite way agree too.
  bool isolate_parts =
      false;  ///< Each connected part of the target is matched to one of the source.
  /// Bones named left give weight only to vertices on the left, and likewise on the right. The
  /// mirror plane is that of the pairs of bones in the source.
  bool keep_sides_apart = false;
  /// Weight of the bi-Laplacian beside the Laplacian, in squared diagonals; >= 0. More is smoother
  /// at the border of what is filled, and overshoots more.
  double smoothness = 1e-3;
  std::uint32_t smoothing_sweeps = 0;    ///< After filling, around what was filled.
  double smoothing_strength = 0.2;       ///< Of a sweep, 0 to 1.
  std::uint32_t maximum_influences = 0;  ///< Per vertex; 0: all.
  std::vector<BoneNames> bone_names;     ///< Counterparts whose names differ.
  /// Names of the bones of the source whose weights are transferred; the others keep their share
  /// of what is left over. Empty: all bones.
  std::vector<std::string> bones;
  double mix = 1.0;  ///< Share of the new weights, 0 to 1; the rest are the target's own.
  /// Per mesh and vertex of the target: whether it keeps its weights. They are continued like
  /// accepted matches. Empty, or empty for a mesh: none.
  std::vector<std::vector<bool>> locked;
  bool dry_run = false;  ///< Only matches; the character stays as it is.
};

/// How a vertex got its weights.
enum class TransferOutcome : std::uint8_t {
  coincident,  ///< It stands on a vertex of the source.
  matched,     ///< Interpolated at an accepted match.
  inpainted,   ///< Continued from matched vertices.
  nearest,     ///< Interpolated at the closest place, though that was not accepted.
  locked,      ///< Kept.
};

/// The change of the weights that a step made, as sum over bones of |after - before| per point.
struct TransferStep {
  std::string_view name;     ///< "negative", "sides", "bones", "mix", "small", "limit".
  std::uint32_t points = 0;  ///< That it changed by more than 1e-9.
  double mean = 0;           ///< Over those points.
  double largest = 0;
};

struct TransferResult {
  /// The target with its new weights. Skeleton and skins begin with the target's; bones and skins
  /// that it lacked follow. Clips stay the target's.
  Character character;
  std::vector<std::vector<TransferOutcome>> outcomes;  ///< Per mesh and vertex.

  std::uint32_t vertices = 0;
  std::uint32_t coincident = 0, matched = 0, inpainted = 0, nearest = 0, locked = 0;
  std::uint32_t too_far = 0;      ///< Matches refused because of their distance.
  std::uint32_t turned_away = 0;  ///< Matches refused because of their normals.
  double largest_distance = 0;    ///< Of an accepted match by TransferOptions::distance, metres.

  std::uint32_t points = 0;  ///< Solved once each: vertices that seams duplicate are one point.
  std::uint32_t parts = 0;   ///< Connected parts of the target.
  std::uint32_t parts_without_match = 0;
  std::uint32_t edges = 0;           ///< 0 where nothing is inpainted, as the next two.
  std::uint32_t clamped_edges = 0;   ///< Whose cotangent weight was negative, tiny or huge.
  std::uint32_t floored_points = 0;  ///< With hardly any area around them.
  std::vector<TransferStep> steps;
  bool has_adopted_skeleton = false;          ///< The target had none of the source's bones.
  std::vector<std::uint32_t> bone_of_source;  ///< The same bone in `character`; kNone: none.
  std::vector<BoneNames> fuzzy_bones;         ///< Taken for counterparts though their names differ.
  std::vector<Finding> findings;              ///< SUNDER_T_…; docs/transfer.md lists them.

  /// Share of the vertices, those that are locked aside, whose match was accepted.
  [[nodiscard]] double matched_share() const {
    const std::uint32_t asked = vertices - locked;
    return asked == 0 ? 1.0 : static_cast<double>(coincident + matched) / asked;
  }
};

/// Gives a target the skin of a source, of which both stand in their bind pose in the same place.
/// Weights are replaced, unless options say otherwise. Bones are matched by name; a target without
/// any of the source's bones gets its skeleton. Coincident vertices of one tear side get the same
/// weights, bit for bit, unless the source parts them there.
///
/// Results do not depend on the unit, the order of vertices or threads.
/// @param source  satisfies validate_character(); so does the target.
/// @return the first fault of a character or option, with its index; not_found if no match was
/// accepted, or for a bone that does not exist; size_mismatch of `locked`. O(vertices log
/// triangles) and the factorisation of one sparse matrix of the points that are filled; allocates.
/// Reentrant.
[[nodiscard]] SUNDER_API Result<TransferResult> transfer_weights(
    const Character& source, const Character& target, const TransferOptions& options = {});

}  // namespace sunder
