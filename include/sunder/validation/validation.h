#pragma once

#include <sunder/certificate/certificate.h>
#include <sunder/core/character.h>
#include <sunder/core/skeleton.h>
#include <sunder/operation/operation.h>
#include <sunder/validation/finding.h>
#include <sunder/validation/transfer.h>
#include <sunder/weights/influences.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder {

/// One row of the table of codes; docs/validation_codes.md has the same rows.
struct FindingKind {
  std::string_view code;
  Severity severity = Severity::note;
  std::string_view unit;
  double threshold = 0.0;
  std::string_view meaning;
  std::string_view advice;
  std::string_view gltf_code;
};
[[nodiscard]] SUNDER_API std::span<const FindingKind> finding_kinds();

/// Platforms whose limits on influences can be simulated.
enum class TargetProfile : std::uint8_t {
  none,
  unity4,   ///< 4 influences, floats.
  unreal8,  ///< 8 influences, 8 bits.
  gltf4,    ///< 4 influences, 8 bits.
  gltf8,    ///< 8 influences, 16 bits.
  webxr,    ///< 4 influences, 16 bits.
};

/// The origin of the joint limits that certificates use.
enum class LimitsFrom : std::uint8_t {
  none,   ///< All joints are free: free_joint_limits().
  clips,  ///< What the source's clips reach: joint_limits_of_clips().
  given,  ///< ValidationOptions::limits.
};

struct ValidationOptions {
  /// The influences as the files store them, one entry per mesh. Empty: the checks of stored
  /// weights are not made.
  std::span<const StoredInfluences> stored_source = {}, stored_target = {};
  /// Bones of the source and the target that belong together although their names differ.
  std::vector<BoneNames> bone_names;
  /// The log that made the target from the source; empty: unknown.
  std::span<const Operation> operations = {};
  TargetProfile profile = TargetProfile::none;
  std::uint32_t random_poses = 64;
  double random_angle = 1.0471975511965976;  ///< Largest turn of a bone from rest, radians.
  std::uint64_t seed = 1;
  /// Deviations above this are reported; share of the diagonal of the source's box.
  double maximum_deviation = 1e-3;
  /// A deviation above this share of the diagonal, or above ten times maximum_deviation, is an
  /// error; a smaller one above maximum_deviation is a warning.
  double error_deviation = 1e-2;
  LimitsFrom limits_from = LimitsFrom::none;
  double clip_margin = 0.0872664625997165;  ///< Radians, for LimitsFrom::clips.
  JointLimits limits;                       ///< Of the source's bones, for LimitsFrom::given.
  /// Most times per clip of ValidationReport::over_time, 30 per second; 0 and 1: none are measured.
  std::uint32_t times_per_clip = 0;
  /// Is called before each stage with its name and the share of stages done.
  std::function<void(std::string_view, double)> progress;
};

/// Deviation of the target from the source surface over one set of poses.
struct PosedFigures {
  std::string_view poses;          ///< "clips", "range of motion", "random".
  std::uint32_t pose_count = 0;    ///< 0: not tested.
  std::uint32_t sample_count = 0;  ///< Vertices compared in each pose.
  double mean = 0.0, rms = 0.0, p95 = 0.0, maximum = 0.0;  ///< Metres.
  double maximum_of_diagonal = 0.0;                        ///< Share.
  /// Share of the mean length of the vertex's edges at bind, converted to metres.
  double maximum_of_edge = 0.0;
  /// Share of all poses of this distribution that `maximum` covers, with confidence 0.95 (Wilks).
  /// 0 unless the poses are independent samples.
  double covered_share = 0.0;
  FindingPlace worst;
};

/// Deviation of the target from the source surface over the time of a clip.
struct ClipDeviation {
  std::uint32_t clip = 0;       ///< Of the source.
  std::vector<double> times;    ///< Seconds, evenly spaced from 0 to the clip's duration.
  std::vector<double> maximum;  ///< One per time, metres.
  std::vector<double> rms;      ///< One per time, over the vertices compared, metres.
};

/// Figures by the definitions of papers, over the random poses; docs/validation.md has the
/// formulas.
struct PaperFigures {
  bool is_tested = false;
  double kg_error = 0.0;          ///< 100 |A - B| / |A - centroid of each frame|.
  double rms_1000 = 0.0;          ///< 1000 |A - B| / sqrt(3 N F), in units of the diagonal.
  double rms = 0.0;               ///< |A - B| / sqrt(N F), metres.
  double distance_mean = 0.0;     ///< Over the first 10 random poses, metres.
  double distance_maximum = 0.0;  ///< Over the first 10 random poses, metres.
  double influence_precision = 1.0, influence_recall = 1.0;  ///< Weights above 1e-4.
  double weight_l1 = 0.0;                                    ///< Mean over vertices.
  std::uint32_t points = 0, frames = 0;
};

/// Bounds the deviation of the target from the source surface in all poses within the limits. In
/// `pose` the vertex `worst` strays by `found`, and no vertex that has a certificate strays farther
/// than `certified` in any of these poses. Nothing is said about the vertices whose
/// ValidationReport::vertex_bound is NaN: `uncertified` of them have a match but no certificate,
/// the others (MatchFigures::target_unmatched) have no match. `certified` holds for the whole
/// target only if there are none of either kind.
struct DeviationBracket {
  bool is_tested = false;
  /// Says why it was not tested, or why some vertices have no certificate.
  std::string why;
  double found = 0.0, certified = 0.0;  ///< Metres.
  FindingPlace worst;
  ModelPose pose;                 ///< Of the source's skeleton.
  std::uint32_t uncertified = 0;  ///< Matched vertices without a certificate.
};

/// How the two surfaces were matched, in bind space. Distances are converted to metres by
/// ValidationReport::metres_per_bind_unit.
struct MatchFigures {
  std::uint32_t target_samples = 0;  ///< Vertices of the target looked up on the source.
  std::uint32_t target_unmatched = 0;
  double target_distance = 0.0;      ///< The largest distance of an accepted match, metres.
  std::uint32_t source_samples = 0;  ///< Vertices of the source looked up on the target.
  std::uint32_t source_unmatched = 0;
  double source_distance = 0.0;  ///< The same for vertices of the source.
};

enum class Verdict : std::uint8_t { pass, fail, not_tested };

struct CodeVerdict {
  std::string_view code;
  Verdict verdict = Verdict::pass;
  std::string why;  ///< Where it was not tested.
};

struct ValidationReport {
  std::vector<Finding> findings;      ///< By severity, then in the order of the table.
  std::vector<CodeVerdict> verdicts;  ///< One per row of the table. A note is no failure.
  std::vector<PosedFigures> posed;
  /// One per clip of the source with a duration, with ValidationOptions::times_per_clip.
  std::vector<ClipDeviation> over_time;
  DeviationBracket bracket;
  PaperFigures papers;
  MatchFigures matching;
  double diagonal = 0.0;  ///< Of the source's box in the rest pose, metres.
  double scale = 1.0;     ///< The target was divided by this before it was compared.
  /// The length in the rest pose, in metres, of a unit length of the source's bind space: 0.01
  /// where an armature scales centimetres to metres. The median over the bones of its skins.
  double metres_per_bind_unit = 1.0;
  std::vector<std::uint64_t> influence_histogram;  ///< Vertices of the target by influence count.
  /// The pose of the source's skeleton in which the largest deviation was found.
  ModelPose worst_pose;
  /// Per vertex of the target, all meshes one after the other: the largest deviation from the
  /// source surface over all poses tried, and the bound for all poses within the limits. Metres;
  /// NaN: no match, or no certificate.
  std::vector<float> vertex_deviation, vertex_bound;
  /// Per bone of the target: its counterpart in the source, or kNone.
  std::vector<std::uint32_t> source_bone_of_target;
};

/// Compares the skin of a target with that of its source: the stored weights, the deformation, and
/// the place of the weights on the surface. A fault that the source has at the same place is a
/// note.
///
/// @param source, target  satisfy validate_character().
/// @return the first fault of a character; size_mismatch for stored influences of other meshes;
///         not_found for a bone of the mapping; limit_exceeded (out of memory).
/// O((vertices + triangles) x poses), allocates. Reentrant; the same bits each time.
[[nodiscard]] SUNDER_API Result<ValidationReport> validate_skin(
    const std::shared_ptr<const Character>& source, const std::shared_ptr<const Character>& target,
    const ValidationOptions& options = {});

/// Returns the name of a severity: "note", "warning" or "error".
[[nodiscard]] SUNDER_API std::string_view severity_name(Severity severity);

}  // namespace sunder
