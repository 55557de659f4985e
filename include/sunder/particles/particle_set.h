#pragma once

#include <sunder/particles/authored_tissue.h>
#include <sunder/particles/material.h>
#include <sunder/particles/state_arrays.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

namespace particles {
struct SetData;
struct Structure;
struct StructureOf;
}  // namespace particles

/// How a surface is divided into particles.
struct DecompositionOptions {
  /// Radius of a particle, from its seed along the surface; in metres from 10^-33 to 10^37.
  double range = 0.1;
  /// Whether `range` is a fraction of the diagonal of the box around the surface; otherwise metres.
  bool is_fraction = true;
  std::uint64_t seed = 0;  ///< Seed of the scattered order in which points become seeds.
};

struct DecompositionReport {
  std::uint32_t particles = 0;
  std::uint32_t points = 0;            ///< Points with a face; only these can be moved.
  std::uint32_t covered = 0;           ///< Points that belong to a particle: all that have a face.
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

/// A particle whose cell borders on that of another one, and that is coupled to it.
struct ParticleNeighbour {
  std::uint32_t particle = 0;
  std::uint32_t edges = 0;  ///< Number of edges of faces from one cell to the other.
  /// The force between the two in a membrane of 1 N/m, per metre by which their displacements
  /// differ: the length of their common border by the distance of their seeds. >= 0.
  double coupling = 0.0;
  /// The conormal of the common border, towards the neighbour, times the border's length, metres.
  Vec3d across = Vec3d::Zero();
  Vec3d middles = Vec3d::Zero();  ///< Sum of the middles of these edges.
};

/// The position and linear map of a particle by the pose alone.
struct ParticleRest {
  Vec3d place = Vec3d::Zero();  ///< Posed centroid of its members, model space, metres.
  /// Mean of the members' blended linear parts, relative to bind space.
  Mat3d linear = Mat3d::Identity();
};

/// A border edge that a tear, cut or bore created.
struct LipEdge {
  std::array<std::uint32_t, 2> points = {};
  /// Length of the edge times its conormal, which lies in the surface and points away from the
  /// opening; metres, in the decomposition's pose. The tissue across the edge pulled with minus
  /// this times the tension (N/m).
  Vec3f inward = Vec3f::Zero();
};

/// The decomposition of a character: made once, on any thread, and shared by the sets of all its
/// instances. Immutable; const calls are thread-safe.
class SUNDER_API ParticleAsset {
 public:
  ///
  /// @param model  of the character, not torn. Its instances have models of the same source.
  /// @return as ParticleSet::create(); invalid_argument for a torn model. O(points + memberships).
  static Result<std::shared_ptr<const ParticleAsset>> create(
      const TornModel& model, const ModelPose& pose, const DecompositionOptions& options = {},
      const AuthoredTissue& tissue = {});
  ~ParticleAsset();

  [[nodiscard]] const DecompositionReport& report() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  friend class ParticleSet;
  explicit ParticleAsset(std::shared_ptr<const particles::Structure> structure);
  std::shared_ptr<const particles::Structure> structure_;
};

/// The surface of a torn model, divided into overlapping clusters of points that follow its pose
/// and its tears. This is their structure; SoftBody or a physics engine moves them. A particle
/// consists of the points within its range of its seed, along the surface; its rest is their posed
/// centroid, computed from bones alone. After Kamarianakis, Protopsaltis, Tamiolakis, Papagiannakis
/// 2022 [kamarianakis2022tearing]; see docs/particles.md.
///
/// Not thread-safe: one thread at a time per set, including const calls where the text says so.
/// Different sets are independent.
class SUNDER_API ParticleSet {
 public:
  ///
  /// @param pose  the pose in which distances along the surface are measured, e.g. the rest pose.
  /// @param tissue  of the model's source. Factors and perforations change no particle.
  /// @return invalid_argument for the options; as validate_authored_tissue(); size_mismatch or
  /// non_finite_value for the pose;
  ///         empty_input for a model without a face; limit_exceeded for more than 2^20 particles,
  ///         or if out of memory. O(points + memberships).
  static Result<ParticleSet> create(const TornModel& model, const ModelPose& pose,
                                    const DecompositionOptions& options = {},
                                    const AuthoredTissue& tissue = {});
  /// The set of an instance that is not torn yet. It shares the asset, which it keeps, and copies
  /// it when it first follows a tear. The results have the same bits as those of a set of its own.
  /// @return empty_input for a null asset; invalid_argument for a model of another source, or a
  /// torn
  ///         one; limit_exceeded if out of memory. O(1).
  static Result<ParticleSet> create(std::shared_ptr<const ParticleAsset> asset,
                                    const TornModel& model);

  ~ParticleSet();
  ParticleSet(ParticleSet&&) noexcept;
  ParticleSet& operator=(ParticleSet&&) noexcept;

  /// Report of create(). Tears do not update it.
  [[nodiscard]] const DecompositionReport& report() const;

  // ---- Particles. Indices are unchecked.

  [[nodiscard]] std::uint32_t particle_count() const;
  /// A number that no other particle of the set ever had. (Indices are reused after undo.)
  [[nodiscard]] std::uint64_t serial(std::uint32_t particle) const;
  /// The point from which the particle was grown.
  [[nodiscard]] std::uint32_t seed(std::uint32_t particle) const;
  /// Metres, in the decomposition's pose.
  [[nodiscard]] double range(std::uint32_t particle) const;
  /// Points of a particle, ascending. O(members log members), allocates. @return limit_exceeded:
  /// out of memory.
  [[nodiscard]] Result<std::vector<std::uint32_t>> members(std::uint32_t particle) const;
  [[nodiscard]] std::uint32_t member_count(std::uint32_t particle) const;
  /// Particles whose cells border on its own, ascending.
  [[nodiscard]] std::span<const ParticleNeighbour> neighbours(std::uint32_t particle) const;
  /// Area of its cell in the decomposition's pose, square metres: a third of each face around its
  /// points, without walls and caps. 0 for a particle to whose seed no point is nearest.
  [[nodiscard]] double area(std::uint32_t particle) const;
  /// For a particle created by a tear: the influences on its seed before the tear, which determine
  /// its displacement and velocity. Weights are all 0 for a particle of the decomposition.
  [[nodiscard]] const ParticleInfluences& parents(std::uint32_t particle) const;

  // ---- Points. Indices are unchecked.

  [[nodiscard]] std::uint32_t point_count() const;
  [[nodiscard]] std::span<const ParticleMembership> memberships(std::uint32_t point) const;
  /// Per point.
  [[nodiscard]] std::span<const ParticleInfluences> influences() const;
  /// Per point: the particle in whose cell it is, which is the one with the nearest seed; kNone if
  /// it belongs to none.
  [[nodiscard]] std::span<const std::uint32_t> owners() const;
  /// Per point: gradients of its influences' weights along the surface, in the decomposition's
  /// pose; for normals, see VertexDisplacements. Empty if out of memory. Valid until the next call
  /// that changes the set. O(points changed since the last call); O(points) in the first one,
  /// unless the set shares an asset of a model with normals or tangents.
  [[nodiscard]] std::span<const ParticleGradients> gradients(const TornModel& model);
  /// Per vertex of a mesh: its point; kNone if no face uses the vertex.
  [[nodiscard]] std::span<const std::uint32_t> vertex_points(std::uint32_t mesh) const;
  /// Per point: its position in the decomposition's pose, model space, metres.
  [[nodiscard]] std::span<const Vec3f> positions() const;
  /// Border edges that operations created and that are still open, in order of creation.
  [[nodiscard]] std::span<const LipEdge> lips() const;

  // ---- Poses.

  /// Evaluates the rest of some particles in a pose. Not for concurrent use: it uses memory of the
  /// set.
  ///
  /// @param particles  in any order, unchecked.
  /// @param rest  one entry for each of them, written.
  /// @return size_mismatch or non_finite_value for the pose (nothing is written). O(bones +
  ///         particles x their bones); no allocation.
  [[nodiscard]] Status rest(const ModelPose& pose, std::span<const std::uint32_t> particles,
                            std::span<ParticleRest> rest) const;

  // ---- Tears.

  /// Follows a call that changed the model: an operation, an extension of a stroke, undo, redo,
  /// other weights. Call it once after each of them, with its records. Afterwards no particle has
  /// points of both lips, except at the tips; undo restores every bit. O(faces torn); settle() does
  /// the work farther from the lips. Allocates the data for undo.
  ///
  /// @return invalid_argument for another model, or one that was compacted: nothing is changed,
  ///         create a new set. limit_exceeded if out of memory: see is_broken().
  Status follow(const TornModel& model, std::span<const ChangeRecord> changes);

  /// Copies what the set shares with others now, which the first follow() of a tear would do
  /// otherwise, and unpacks it. O(points + memberships), once. @return limit_exceeded: out of
  /// memory.
  Status prepare_to_follow();
  /// Stores what the set knows of points in proportion to what tears changed. For a set whose
  /// bodies are at rest. It is unpacked, bit for bit, by the next change, by a step of a body, and
  /// by what reads points, which returns nothing without memory for it; spans that were read
  /// before are invalid. Does nothing if there is work for settle(), during a stroke, while there
  /// is a ParticleFork, for gradients that are not up to date, and if the set was made without an
  /// asset. O(points).
  /// @return limit_exceeded: out of memory, nothing changes.
  Status pack();

  /// Continues the work of follow(), for at most `points` points: particles that a long tear passes
  /// are separated completely. Call it once per frame; SoftBody::step() does. Other operations may
  /// come in between. While operations are undone and may be redone, it waits.
  ///
  /// @return whether work remains.
  bool settle(const TornModel& model, std::uint32_t points = 500);

  /// Whether memory ran out in follow() or settle(). The data of particles and points is then
  /// incomplete, and a SoftBody of the set returns limit_exceeded: create a new set.
  [[nodiscard]] bool is_broken() const;
  /// Whether no work remains for settle().
  [[nodiscard]] bool is_settled() const;

  /// Increases with every change.
  [[nodiscard]] std::uint64_t revision() const;
  /// Points whose influences the last follow() or settle() changed, to be uploaded: at most eight
  /// ranges. Not for concurrent use. O(changed points x log).
  [[nodiscard]] DirtyRanges dirty_points() const;

  /// Bytes of the set itself, without a shared asset.
  [[nodiscard]] std::size_t memory_bytes() const;

  /// The whole state, with the work that is left and all that undo needs. A set restored from it
  /// goes on with the same bits. O(size of the set), allocates.
  /// @return invalid_argument for a set that is_broken(), or that was not made from an asset;
  ///         limit_exceeded: out of memory.
  [[nodiscard]] Result<StateArrays> save() const;
  /// The set as it was saved.
  /// @param asset  with the bits of that of the saved set.
  /// @param model  in the state in which it was then.
  /// @return as create(); invalid_argument, index_out_of_range, size_mismatch or non_finite_value
  /// if
  ///         the arrays are not a state of this asset and model.
  static Result<ParticleSet> restore(std::shared_ptr<const ParticleAsset> asset,
                                     const TornModel& model, const StateArrays& state);

 private:
  friend struct particles::StructureOf;
  explicit ParticleSet(std::unique_ptr<particles::SetData> data);
  std::unique_ptr<particles::SetData> data_;
};

/// Points where the two lips of a tear meet; for a gap, the middle of its end. Ascending. O(edges
/// of lips), allocates.
/// @param model  as follow() left it.
/// @return limit_exceeded: out of memory.
[[nodiscard]] SUNDER_API Result<std::vector<std::uint32_t>> find_tips(const ParticleSet& particles,
                                                                      const TornModel& model);

/// The result of a search for a range.
struct FoundRange {
  double range = 0.0;           ///< A fraction of the diagonal, for DecompositionOptions.
  std::uint32_t particles = 0;  ///< Number of particles with that range.
  /// Measured duration of SoftBody::step() with all particles awake in a constant pose; 0: not
  /// measured.
  double step_seconds = 0.0;
};

/// Searches the range that gives the requested number of particles: within 2 %, or as close as
/// possible. Deterministic; may be called by several threads on one model. At most a dozen
/// decompositions.
///
/// @param wanted  >= 1; at most the number of points of the model.
/// @return invalid_argument, and the errors of ParticleSet::create().
SUNDER_API Result<FoundRange> find_range_for_particles(const TornModel& model,
                                                       const ModelPose& pose, std::uint32_t wanted,
                                                       std::uint64_t seed = 0);

/// Searches the smallest range, which gives the finest motion, whose steps do not take longer than
/// requested. Measures on the current machine, so the result varies. Takes a few decompositions,
/// and some milliseconds of steps for each.
///
/// @param seconds  for one step with all particles awake; > 0.
/// @return not_found if no range is fast enough; otherwise as find_range_for_particles().
SUNDER_API Result<FoundRange> find_range_for_step(const TornModel& model, const ModelPose& pose,
                                                  double seconds, const SoftMaterial& material,
                                                  std::uint64_t seed = 0);

}  // namespace sunder
