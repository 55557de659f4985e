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
  double range = 0.1;  ///< How far along the surface a particle reaches from its seed; > 0.
  bool is_fraction =
      true;  ///< `range` is a fraction of the diagonal of the box around the surface; else metres.
  std::uint64_t seed = 0;  ///< Chooses which points become seeds.
};

struct DecompositionReport {
  std::uint32_t particles = 0;
  std::uint32_t points = 0;            ///< Points with a face: those that can be moved.
  std::uint32_t covered = 0;           ///< Points that belong to a particle: all with a face.
  std::uint64_t memberships = 0;       ///< Pairs of a point and a particle.
  std::uint32_t most_memberships = 0;  ///< Greatest number of particles per point.
  double range = 0.0;                  ///< Metres.
  double seconds = 0.0;                ///< Duration of create().
};

/// The membership of a point in a particle.
struct ParticleMembership {
  std::uint32_t particle = 0;
  float reach = 0.0f;  ///< Distance from the seed along the surface, as a fraction of the
                       ///< particle's range; in [0, 1).
};

/// A particle that has points in common with another one, which it pulls.
struct ParticleNeighbour {
  std::uint32_t particle = 0;
  std::uint32_t points = 0;  ///< Number of points whose influences name both.
  double shared = 0.0;       ///< Sum over those points of the product of the two weights.
};

/// Where a particle is when only the pose moves it, and how the pose turns it.
struct ParticleRest {
  Vec3d place = Vec3d::Zero();  ///< Posed centroid of its members, model space, metres.
  Mat3d linear =
      Mat3d::Identity();  ///< Mean of the members' blended linear parts, relative to bind space.
};

/// An edge of a border that a tear, cut or bore made.
struct LipEdge {
  std::array<std::uint32_t, 2> points = {};
  /// Length of the edge times its conormal, which lies in the surface and points away from the
  /// opening; metres, in the decomposition's pose. The tissue beyond the edge pulled with the
  /// tension (N/m) times the opposite of this.
  Vec3f inward = Vec3f::Zero();
};

/// The surface of a torn model, divided into overlapping clusters of points that follow its pose
/// and its tears. This is their structure; SoftBody or a physics engine moves them.
///
/// Every point within a particle's range of its seed, along the surface, belongs to the particle.
/// Its rest place is the posed centroid of its members, evaluated from bones alone. After
/// Kamarianakis, Protopsaltis, Tamiolakis, Papagiannakis 2022 [kamarianakis2022tearing]; see
/// docs/particles.md.
///
/// Not thread-safe: one thread at a time per set, const calls included where the text says so.
/// Different sets are independent.
class SUNDER_API ParticleSet {
 public:
  /// @param pose  in which distances along the surface are measured, e.g. the rest pose.
  /// @return invalid_argument for the options; size_mismatch or non_finite_value for the pose;
  /// empty_input for a model without a
  ///         face; limit_exceeded for more than 2^20 particles, or out of memory.
  /// O(points + memberships).
  static Result<ParticleSet> create(const TornModel& model, const ModelPose& pose,
                                    const DecompositionOptions& options = {});

  ~ParticleSet();
  ParticleSet(ParticleSet&&) noexcept;
  ParticleSet& operator=(ParticleSet&&) noexcept;

  /// Report of create(). Tears do not update it.
  [[nodiscard]] const DecompositionReport& report() const;

  // ---- Particles. Indices are unchecked.

  [[nodiscard]] std::uint32_t particle_count() const;
  /// A number that no other particle of the set ever had: undo removes particles, and later tears
  /// reuse their indices.
  [[nodiscard]] std::uint64_t serial(std::uint32_t particle) const;
  /// The point from which the particle was grown.
  [[nodiscard]] std::uint32_t seed(std::uint32_t particle) const;
  /// Metres, in the decomposition's pose.
  [[nodiscard]] double range(std::uint32_t particle) const;
  /// Points of a particle, ascending. O(members log members), allocates. @return limit_exceeded:
  /// out of memory.
  [[nodiscard]] Result<std::vector<std::uint32_t>> members(std::uint32_t particle) const;
  [[nodiscard]] std::uint32_t member_count(std::uint32_t particle) const;
  /// Particles with which it has points in common, ascending.
  [[nodiscard]] std::span<const ParticleNeighbour> neighbours(std::uint32_t particle) const;
  /// How much of two neighbours is common: `shared` over the lesser sum of weights of the two; in
  /// [0, 1].
  [[nodiscard]] double coupling(std::uint32_t particle, const ParticleNeighbour& neighbour) const;
  /// For a particle that a tear made: the influences on its seed before the tear, from which its
  /// displacement and velocity come. Weights are all 0 for a particle of the decomposition.
  [[nodiscard]] const ParticleInfluences& parents(std::uint32_t particle) const;

  // ---- Points. Indices are unchecked.

  [[nodiscard]] std::uint32_t point_count() const;
  [[nodiscard]] std::span<const ParticleMembership> memberships(std::uint32_t point) const;
  /// Per point.
  [[nodiscard]] std::span<const ParticleInfluences> influences() const;
  /// Per point: gradients of its influences' weights along the surface, in the decomposition's
  /// pose; for normals, see VertexDisplacements. Empty where memory ran out. Valid until the next
  /// call that changes the set. O(points) at first, then O(points changed since).
  [[nodiscard]] std::span<const ParticleGradients> gradients(const TornModel& model);
  /// Per vertex of a mesh: its point; kNone where no face uses the vertex.
  [[nodiscard]] std::span<const std::uint32_t> vertex_points(std::uint32_t mesh) const;
  /// Per point: its place in the decomposition's pose, model space, metres.
  [[nodiscard]] std::span<const Vec3f> positions() const;
  /// Edges of borders that operations made and have not closed again, in the order in which they
  /// were made.
  [[nodiscard]] std::span<const LipEdge> lips() const;

  /// Points where the two lips of a tear meet; for a gap, the middle of its end. Ascending. O(edges
  /// of lips), allocates.
  /// @param model  as follow() left it.
  /// @return limit_exceeded: out of memory.
  [[nodiscard]] Result<std::vector<std::uint32_t>> tips(const TornModel& model) const;

  // ---- Poses.

  /// Evaluates the rest of some particles in a pose. Not to be called by two threads at once: it
  /// uses memory of the set.
  /// @param particles  in any order, unchecked. @param rest  one entry for each of them, written.
  /// @return size_mismatch or non_finite_value for the pose (nothing is written).
  /// O(bones + particles x their bones); no allocation.
  [[nodiscard]] Status rest(const ModelPose& pose, std::span<const std::uint32_t> particles,
                            std::span<ParticleRest> rest) const;

  // ---- Tears.

  /// Follows what a call did to the model: an operation, an extension of a stroke, undo, redo,
  /// other weights. To be called once after each of them, with the records that it wrote. No
  /// particle then holds points of both lips, except at the tips; undo restores every bit.
  /// @return invalid_argument for another model, or one that was compacted: nothing is changed,
  /// decompose again. limit_exceeded out
  ///         of memory: see is_broken().
  /// O(faces torn): what lies farther from the lips is left to settle(). Allocates what undo
  /// restores.
  Status follow(const TornModel& model, std::span<const ChangeRecord> changes);

  /// Continues what follow() left, for at most `points` points: particles that a long tear passes
  /// are separated all the way. To be called once per frame; SoftBody::step() does. follow()
  /// completes it before it begins.
  /// @return whether there is more to do.
  bool settle(const TornModel& model, std::uint32_t points = 2000);

  /// Whether memory ran out in follow() or settle(): decompose again. What the set says of
  /// particles and points is incomplete then, and a SoftBody of it answers limit_exceeded.
  [[nodiscard]] bool is_broken() const;
  /// Whether follow() left nothing to settle().
  [[nodiscard]] bool is_settled() const;

  /// Grows whenever anything changed.
  [[nodiscard]] std::uint64_t revision() const;
  /// Points whose influences the last follow() or settle() changed, to be uploaded again: at most
  /// eight ranges. Not to be called by two threads at once. O(changed points x log).
  [[nodiscard]] DirtyRanges dirty_points() const;

 private:
  explicit ParticleSet(std::unique_ptr<particles::Structure> structure);
  std::unique_ptr<particles::Structure> structure_;
};

/// A range that fits what was wanted.
struct FoundRange {
  double range = 0.0;           ///< A fraction of the diagonal, for DecompositionOptions.
  std::uint32_t particles = 0;  ///< Number of particles that it makes.
  double step_seconds = 0.0;  ///< Measured duration of SoftBody::step() with all of them awake in a
                              ///< still pose; 0: not measured.
};

/// Searches the range that makes about as many particles as wanted: within 2 %, or as near as
/// ranges come. Deterministic; safe to call from several threads on one model.
/// @param wanted  >= 1; at most as many as the model has points.
/// @return invalid_argument, and the errors of ParticleSet::create(). At most a dozen
/// decompositions.
SUNDER_API Result<FoundRange> find_range_for_particles(const TornModel& model,
                                                       const ModelPose& pose, std::uint32_t wanted,
                                                       std::uint64_t seed = 0);

/// Searches the smallest range, and so the finest motion, whose steps take no longer than wanted.
/// Each trial is timed on this machine, so the result varies.
/// @param seconds  for one step with all particles awake; > 0.
/// @return not_found where no range is fast enough; else as find_range_for_particles(). A few
/// decompositions and some milliseconds
///         of steps for each.
SUNDER_API Result<FoundRange> find_range_for_step(const TornModel& model, const ModelPose& pose,
                                                  double seconds, const SoftMaterial& material,
                                                  std::uint64_t seed = 0);

}  // namespace sunder
