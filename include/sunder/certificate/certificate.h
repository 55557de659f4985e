#pragma once

#include <sunder/core/character.h>
#include <sunder/core/parallel_for.h>

#include <cstdint>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

namespace sunder {

// Bounds that hold in every pose within joint limits, for linear blend skinning only. Method, proof
// and limits: docs/certificate.md.

/// One term of a difference of two skinned points of one skeleton: model_from_bind(bone) * (x, m).
struct SkinTerm {
  std::uint32_t bone = 0;   ///< In the skeleton.
  double m = 0.0;           ///< Net weight.
  Vec3d x = Vec3d::Zero();  ///< Weighted bind position, model space of the bind pose, metres.
};

/// Differences of skinned points, back to back. A point that is equal in both skins has no term.
/// With weights that sum to one, a row is a skinned point itself.
struct SkinDifferences {
  std::vector<std::uint32_t> first = {0};  ///< One per point and one more: offsets into `terms`.
  std::vector<SkinTerm> terms;             ///< Each bone at most once per point, ascending.
  /// The largest |sum_k share_k * (sum of the weights of vertex k - 1)| that append_difference()
  /// took out of a row when it divided weights by their sums.
  double divided_sum = 0.0;
};

/// A vertex and its coefficient in a sum of posed vertices.
struct VertexShare {
  std::uint32_t vertex = 0;
  double share = 1.0;
};

/// Appends one row: sum_k share_k * (posed vertex k) of a mesh, weights divided by their sum. Terms
/// that are zero are dropped, so copies with equal positions and weights and the shares 1 and -1
/// give an empty row. A T-junction: {v, 1}, {a, t - 1}, {b, -t}. The stretch of an edge: {a, 1},
/// {b, -1}. Morph targets are not applied.
/// @param bind  of the character, see bind_pose(); in its space are the rows.
/// @return size_mismatch, index_out_of_range or weights_not_normalized; nothing is appended then.
[[nodiscard]] SUNDER_API Status append_difference(const Character& character, const ModelPose& bind,
                                                  std::uint32_t mesh,
                                                  std::span<const VertexShare> shares,
                                                  SkinDifferences& differences);

/// How a bone may move relative to its parent. All is measured from the bind pose, not from the
/// default pose. Axes and slides are given along the axes of the bone's frame at bind.
struct JointRange {
  enum class Turn : std::uint8_t {
    ball,   ///< About any axis through the bone's origin.
    hinge,  ///< About one axis through the bone's origin.
  };
  Turn turn = Turn::ball;
  double angle = std::numbers::pi;    ///< Ball: the largest rotation, radians, >= 0.
  Vec3d axis = Vec3d(1.0, 0.0, 0.0);  ///< Hinge: any length but zero.
  double lower = -std::numbers::pi;   ///< Hinge: radians, <= upper; zero may lie outside.
  double upper = std::numbers::pi;    ///< Hinge.
  Vec3d slide_from = Vec3d::Zero();   ///< The bone's origin moves along this segment, metres of
  Vec3d slide_to = Vec3d::Zero();     ///< model space, ...
  double slide_radius = 0.0;          ///< ... and so far to any side. Infinity: no range is known.
  double scale_lower = 1.0;           ///< Stretch along any axes, relative to bind, >= 0.
  double scale_upper = 1.0;           ///< Infinity: no range is known.
};

/// Ranges of all bones. Callers fill it from a file or a robot description, or use a function.
struct JointLimits {
  std::vector<JointRange> of_bone;  ///< One per bone of the skeleton.
};

/// Every bone rotates freely (180 degrees). Translations and scales reach as far as the rest pose
/// and the clips take them; roots translate without a range.
/// @param character  satisfies validate_character(). @param bind  one matrix per bone, invertible.
/// @return size_mismatch, non_finite_value or invalid_argument with the bone. O(keys), allocates.
[[nodiscard]] SUNDER_API Result<JointLimits> free_joint_limits(const Character& character,
                                                               const ModelPose& bind);

/// The largest rotation, translation and scale from bind that each bone reaches in the rest pose or
/// at any time of any clip, between keys too. Cross-fades and layers that mix clips stay within
/// them where a bone's angle is below 90 degrees; additive layers, pulls and poses changed by hand
/// do not. Rotations are exact for step and linear keys and
/// within 0.002 radians above the largest for cubic splines; docs/certificate.md.
/// @param margin  radians, >= 0; added to the angle of each bone that a clip rotates.
[[nodiscard]] SUNDER_API Result<JointLimits> joint_limits_of_clips(const Character& character,
                                                                   const ModelPose& bind,
                                                                   double margin);

/// A skeleton at bind with limits of its joints, prepared for certificates. Immutable; copies share
/// their state.
class SUNDER_API JointTree {
 public:
  /// @return size_mismatch, not_a_tree (a parent after its child), non_finite_value or
  /// invalid_argument with the bone: a range outside of what JointRange documents. O(bones).
  [[nodiscard]] static Result<JointTree> create(const Skeleton& skeleton, const ModelPose& bind,
                                                const JointLimits& limits);
  struct State;  ///< For the library alone.
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  explicit JointTree(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// Why points have no certificate.
struct CertificateGap {
  enum class Reason : std::uint8_t {
    unequal_sums,    ///< The weights of the two skins differ in their sum: the root carries them
                     ///< apart.
    no_slide_range,  ///< Weight moved across a bone that translates without a range.
    no_scale_range,  ///< A bone at or above the points scales without a range.
  };
  Reason reason = Reason::unequal_sums;
  std::uint32_t bone = kNone;   ///< The bone without a range.
  std::uint32_t first = kNone;  ///< The first point concerned.
  std::uint32_t count = 0;      ///< Number of points.
};

/// Weight that crosses a bone whose slide has no range, at most 4e-6: rounding of sums of weights.
struct SlideResidual {
  std::uint32_t bone = kNone;
  double weight = 0.0;  ///< Of all points the largest: metres per metre that the bone slides.
  std::uint32_t point = kNone;  ///< The first with that weight.
};

/// No pose within the limits moves the two skins of a point farther apart than its bound and what
/// sums of weights that are not quite equal add: `slide_residuals` and `sum_residual`.
struct DeviationCertificate {
  std::vector<double> bound;    ///< One per point, metres; infinity where there is no certificate.
  double maximum = 0.0;         ///< Of the points that have a certificate.
  std::uint32_t worst = kNone;  ///< Its point; kNone if the maximum is 0.
  std::vector<CertificateGap>
      gaps;  ///< One per reason and bone; empty: `maximum` is for all points.
  /// One per bone without a slide range that such weight crosses, ascending: a pose in which the
  /// bone slides by d metres from bind may exceed a bound by d times its weight.
  std::vector<SlideResidual> slide_residuals;
  /// The largest difference of two sums of weights, also of those that append_difference() divided
  /// by their sums, because skinning does not. Of rounding alone, at most 4e-6 where rows have it.
  /// A pose in which the bones of a point are d metres from the model's origin may exceed a bound
  /// by d times as much.
  double sum_residual = 0.0;
};

struct CertificateOptions {
  double rounding = 0.0;  ///< Metres added to each point with terms, for skinning in float32.
  std::uint32_t refined_points = 64;  ///< Worst points whose bound is minimised joint by joint.
};

/// Bounds the deviation of all points. A point without terms has exactly 0. Bounds are multiplied
/// by 1 + 1e-10 for rounding. O(terms * joints between them), independent of poses. Allocates one
/// array per result and task, and a few per refined point. The same bits at any number of threads.
/// @return index_out_of_range or non_finite_value with the point, invalid_argument for options.
[[nodiscard]] SUNDER_API Result<DeviationCertificate> certify_deviation(
    const JointTree& tree, const SkinDifferences& differences,
    const CertificateOptions& options = {}, const ParallelFor& parallel_for = {});

/// The points with the largest bounds that are certified and not 0, largest first, at most `count`.
/// None if there is no memory.
[[nodiscard]] SUNDER_API std::vector<std::uint32_t> worst_points(
    const DeviationCertificate& certificate, std::size_t count);

/// The motion of a bone in a pose, relative to its parent and to bind:
/// x -> centre + slide + rotation * stretch * (x - centre), in model space of the bind pose.
struct BoneMotion {
  std::uint32_t bone = 0;
  Quatd rotation = Quatd::Identity();
  Vec3d slide = Vec3d::Zero();        ///< Metres.
  Mat3d stretch = Mat3d::Identity();  ///< Symmetric.
};

/// A pose within the limits.
struct FoundPose {
  double found = 0.0;  ///< In this pose: the deviation in metres, or the smallest singular value.
  std::vector<BoneMotion> motions;  ///< Bones that are not as at bind, ascending.
  ModelPose pose;                   ///< The whole skeleton, with the morph weights of bind.
};

struct SearchOptions {
  std::uint32_t restarts = 8;  ///< Random starts in addition to the one at bind.
  std::uint64_t seed = 1;
};

/// Searches the pose within the limits that moves a point's two skins farthest apart, by coordinate
/// ascent from bind and from the best of some random poses: each joint in turn takes its best place
/// in closed form. `found` never exceeds the bound
/// but for rounding, and is usually above 0.85 of it; docs/certificate.md has figures.
/// @return index_out_of_range for the point; unsupported_feature if it has no certificate.
[[nodiscard]] SUNDER_API Result<FoundPose> find_worst_pose(const JointTree& tree,
                                                           const SkinDifferences& differences,
                                                           std::uint32_t point,
                                                           const SearchOptions& options = {});

/// Skinned points with the linear parts of what moves them. A skin whose bind matrices are not
/// those of the bind pose (skins may differ) has parts that are not the identity at bind.
struct SkinBlends {
  SkinDifferences points;      ///< Rows with m >= 0 that sum to one.
  std::vector<Mat3d> at_bind;  ///< One per term, or none: the identity everywhere.
};

/// Appends the row of append_difference() for a vertex and its matrices: model_from_bone at bind
/// times the bind matrix of the skin, of terms with several slots the mean by weight.
/// @return as append_difference(); size_mismatch unless there is one matrix per term already.
[[nodiscard]] SUNDER_API Status append_blend(const Character& character, const ModelPose& bind,
                                             std::uint32_t mesh, std::uint32_t vertex,
                                             SkinBlends& blends);

/// Lower bounds, in every pose within the limits, of the smallest singular value of the blended
/// matrix sum_i w_i A_i N_i, relative to what it is at bind (N_i are `at_bind`), one per point.
/// Where it is positive, the matrix never inverts, and for rigid bones its condition is at most the
/// inverse of the bound; elsewhere the point may collapse. -1 if the matrix is flat at bind or one
/// of its parts mirrors it. O(terms^2 * joints between them).
/// @return index_out_of_range, weights_not_normalized or non_finite_value with the point, or
/// size_mismatch.
[[nodiscard]] SUNDER_API Result<std::vector<double>> certify_blend(
    const JointTree& tree, const SkinBlends& blends, const ParallelFor& parallel_for = {});

/// Searches the pose within the limits in which the blended matrix of a point, relative to bind,
/// has its smallest singular value.
/// @return index_out_of_range for the point; unsupported_feature if a scale has no range or
/// certify_blend() has no bound.
[[nodiscard]] SUNDER_API Result<FoundPose> find_collapse_pose(const JointTree& tree,
                                                              const SkinBlends& blends,
                                                              std::uint32_t point,
                                                              const SearchOptions& options = {});

/// The changes of weights that certified_influences() may make.
struct InfluenceBudget {
  double maximum_error = 1e-4;        ///< Metres, in every pose within the limits.
  std::uint32_t most_influences = 0;  ///< 0: no limit.
  std::vector<std::uint32_t> bits = {
      32};  ///< Weights a vertex may get: 8, 16 (integers), 32 (float).
};

/// Weights that are certified against the original.
struct CertifiedInfluences {
  SkinWeights weights;                    ///< As the mesh's; largest influences first.
  std::vector<std::uint8_t> bits;         ///< One per vertex: 8, 16 or 32.
  std::vector<double> bound;              ///< One per vertex, metres.
  double maximum = 0.0;                   ///< Of `bound`.
  std::uint32_t above_maximum_error = 0;  ///< Number of vertices that the budget cannot keep below.
};

/// Chooses per vertex the smallest number of influences, and for these the fewest bits, at which
/// one of two choices has a certificate of the change of at most the maximum error: the largest
/// influences, divided by their sum; or those that are left when one after another gives its weight
/// to the bone that moves most like its own. If none has, the smallest bound within the budget is
/// taken and counted. Weight that crosses a slide without a range has no bound here, however small.
/// Integer weights sum to 255 or 65535 exactly, by the largest remainder.
/// @return the faults of append_difference(); invalid_argument for the budget. O(V n^2), allocates.
[[nodiscard]] SUNDER_API Result<CertifiedInfluences> certified_influences(
    const Character& character, const ModelPose& bind, const JointTree& tree, std::uint32_t mesh,
    const InfluenceBudget& budget);

}  // namespace sunder
