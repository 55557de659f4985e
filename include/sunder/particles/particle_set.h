#pragma once

#include <sunder/particles/material.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

namespace particles {
struct Structure;
}

/// How a surface is divided into particles.
struct DecompositionOptions {
  double range = 0.1;       ///< d: how far along the surface a particle reaches from its seed; > 0.
  bool is_fraction = true;  ///< Of the diagonal of the box around the surface; else metres of model space.
  std::uint64_t seed = 0;   ///< Chooses which points become seeds.
};

struct DecompositionReport {
  std::uint32_t particles = 0;
  std::uint32_t points = 0;            ///< Of faces: those that can be moved.
  std::uint32_t covered = 0;           ///< Of those: that belong to a particle. All of them.
  std::uint64_t memberships = 0;       ///< Pairs of a point and a particle.
  std::uint32_t most_memberships = 0;  ///< Of one point.
  double range = 0.0;                  ///< Metres.
  double seconds = 0.0;                ///< That it took.
};

/// A point in a particle.
struct ParticleMembership {
  std::uint32_t particle = 0;
  float reach = 0.0f;  ///< Distance from the particle's seed along the surface, as a part of its range; in [0, 1).
};

/// Particles that have points in common pull at one another.
struct ParticleNeighbour {
  std::uint32_t particle = 0;
  std::uint32_t points = 0;  ///< In common: whose influences name both.
  double shared = 0.0;       ///< Sum over those of the product of their two weights.
};

/// Where a particle is when nothing but the pose moves it, and how the pose turns it.
struct ParticleRest {
  Vec3d place = Vec3d::Zero();       ///< The posed centroid of its members, model space.
  Mat3d linear = Mat3d::Identity();  ///< Mean of the members' blended linear parts, relative to bind space.
};

/// An edge of a border that a tear, cut or bore made.
struct LipEdge {
  std::array<std::uint32_t, 2> points = {};
  /// Length of the edge times its conormal, in the surface and away from the opening, in the decomposition's pose; metres. What the
  /// tissue beyond the edge pulled with, before it was gone, is the tension (newtons a metre) times the opposite of this.
  Vec3f inward = Vec3f::Zero();
};

/// A torn model's surface divided into overlapping clusters of points, which follow its pose and its tears. This is their
/// structure; what moves them is SoftBody, or a physics engine.
///
/// Every point within the range d of a particle's seed, along the surface and not through the air, belongs to the particle. A
/// particle's rest place is the posed centroid of its members, whatever the pose, evaluated from bones alone: sum_i M_i c_i, where
/// c_i is the mean over the members of w_vi [v; 1].
///
/// After Kamarianakis, Protopsaltis, Tamiolakis, Papagiannakis 2022 [kamarianakis2022tearing]. See docs/particles.md.
class SUNDER_API ParticleSet {
 public:
  /// @param pose  in which distances along the surface are measured, e.g. the rest pose.
  /// @return invalid_argument for the options; size_mismatch, non_finite_value for the pose; empty_input for a model
  ///         without a face; limit_exceeded for more than 2^20 particles, or without enough memory.
  /// O(points + memberships).
  static Result<ParticleSet> create(const TornModel& model, const ModelPose& pose, const DecompositionOptions& options = {});

  ~ParticleSet();
  ParticleSet(ParticleSet&&) noexcept;
  ParticleSet& operator=(ParticleSet&&) noexcept;

  /// Of the decomposition; `particles` and `seconds` are not brought up to date by tears.
  [[nodiscard]] const DecompositionReport& report() const;

  // ---- Particles. All unchecked.

  [[nodiscard]] std::uint32_t particle_count() const;
  /// A number that no other particle of the set ever had: undo takes particles back, and other tears reuse their indices.
  [[nodiscard]] std::uint64_t serial(std::uint32_t particle) const;
  /// The point that it was grown from.
  [[nodiscard]] std::uint32_t seed(std::uint32_t particle) const;
  /// Metres, in the decomposition's pose.
  [[nodiscard]] double range(std::uint32_t particle) const;
  /// Its points, ascending. O(members), allocates.
  [[nodiscard]] std::vector<std::uint32_t> members(std::uint32_t particle) const;
  [[nodiscard]] std::uint32_t member_count(std::uint32_t particle) const;
  /// Those with which it has points in common, ascending.
  [[nodiscard]] std::span<const ParticleNeighbour> neighbours(std::uint32_t particle) const;
  /// How much of two neighbours is common: `shared` over the lesser sum of weights of the two; in [0, 1].
  [[nodiscard]] double coupling(std::uint32_t particle, const ParticleNeighbour& neighbour) const;
  /// Of a particle that a tear made: where its displacement and velocity come from, as influences on its seed before the tear.
  /// Weights are all 0 for one of the decomposition.
  [[nodiscard]] const ParticleInfluences& parents(std::uint32_t particle) const;

  // ---- Points. All unchecked.

  [[nodiscard]] std::uint32_t point_count() const;
  [[nodiscard]] std::span<const ParticleMembership> memberships(std::uint32_t point) const;
  /// One a point.
  [[nodiscard]] std::span<const ParticleInfluences> influences() const;
  /// One a point: gradients of its influences' weights along the surface, in the decomposition's pose; for normals, see
  /// VertexDisplacements. Valid until the next call that changes the set. O(points) at first, then O(points changed since).
  [[nodiscard]] std::span<const ParticleGradients> gradients(const TornModel& model);
  /// One a vertex of a mesh: its point; kNone where no face uses it.
  [[nodiscard]] std::span<const std::uint32_t> vertex_points(std::uint32_t mesh) const;
  /// Where points are in the decomposition's pose, metres. One a point.
  [[nodiscard]] std::span<const Vec3f> positions() const;
  /// Borders that operations made and have not closed again, in the order in which they were made.
  [[nodiscard]] std::span<const LipEdge> lips() const;

  /// Points in which the two lips of a tear meet; of a gap, the middle of its end. Ascending. O(edges of lips), allocates.
  /// @param model  as follow() left it.
  [[nodiscard]] std::vector<std::uint32_t> tips(const TornModel& model) const;

  // ---- Poses.

  /// Evaluates `rest` for some particles in a pose. @param rest  one each; @param particles ascending or not; unchecked.
  /// @return size_mismatch or non_finite_value for the pose (nothing is written). O(bones + particles x their bones); no allocation
  ///         once warm.
  [[nodiscard]] Status rest(const ModelPose& pose, std::span<const std::uint32_t> particles, std::span<ParticleRest> rest) const;

  // ---- Tears.

  /// Follows what a call did to the model: an operation, an extension of a stroke, undo, redo, other weights. To be called once
  /// after each of them, with the records that it wrote. Only what is near the tear changes. No particle holds points of both lips
  /// then, but for the tips; undo brings back every bit.
  /// @return invalid_argument for another model, or one that was compacted (decompose again). Nothing is changed then.
  ///
  /// O(faces torn): what lies farther from the lips is left to settle(). Allocates: what undo takes back is kept.
  Status follow(const TornModel& model, std::span<const ChangeRecord> changes);

  /// Goes on with what follow() left, for at most so many points: particles that a long tear passes are parted all the way. To be
  /// called once a frame. follow() does what is left before it begins.
  /// @return whether there is more to do.
  bool settle(const TornModel& model, std::uint32_t points = 2000);

  /// Whether follow() left nothing to settle().
  [[nodiscard]] bool is_settled() const;

  /// Grows whenever anything changed.
  [[nodiscard]] std::uint64_t revision() const;
  /// Points whose influences the last follow() or settle() changed: at most eight ranges, to be uploaded again.
  /// O(points log points), of those.
  [[nodiscard]] DirtyRanges dirty_points() const;

 private:
  explicit ParticleSet(std::unique_ptr<particles::Structure> structure);
  std::unique_ptr<particles::Structure> structure_;
};

/// A range that fits what was wanted.
struct FoundRange {
  double range = 0.0;           ///< A fraction of the diagonal, for DecompositionOptions.
  std::uint32_t particles = 0;  ///< That it makes.
  double step_seconds = 0.0;    ///< Of SoftBody::step() with all of them awake, in a still pose, as measured; 0: it was not.
};

/// Searches the range that makes about as many particles as wanted: within 2 %, or as near as ranges come. Deterministic.
/// @param wanted  >= 1; at most as many as the model has points.
/// @return invalid_argument, and what ParticleSet::create() finds. A dozen decompositions at most.
SUNDER_API Result<FoundRange> find_range_for_particles(const TornModel& model, const ModelPose& pose, std::uint32_t wanted,
                                                       std::uint64_t seed = 0);

/// Searches the smallest range, and so the finest motion, whose steps take no longer than wanted, on this machine as it is now:
/// each trial is timed.
/// @param seconds  of one step with all particles awake; > 0.
/// @return not_found where none does; else as find_range_for_particles(). A few decompositions, some milliseconds of steps each.
SUNDER_API Result<FoundRange> find_range_for_step(const TornModel& model, const ModelPose& pose, double seconds,
                                                  const SoftMaterial& material, std::uint64_t seed = 0);

}  // namespace sunder
