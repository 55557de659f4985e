#pragma once

#include <sunder/core/parallel_for.h>
#include <sunder/particles/force_tearing.h>
#include <sunder/particles/soft_body.h>
#include <sunder/skinning/bone_palette.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/tear_stroke.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace sunder {

/// Options of a soft surface. It is decomposed in the rest pose.
struct SoftTissue {
  DecompositionOptions decomposition;
  /// At least one; all particles start with the first.
  std::vector<SoftMaterial> materials = {SoftMaterial()};
  SoftBodyOptions body;
};

struct CharacterInstanceOptions {
  TornCapacity capacity;  ///< Room for operations. Default: the instance grows as needed.
  /// How new vertices are skinned, if an operation has no options of its own.
  WeightOptions weights;
  std::optional<SoftTissue> soft;  ///< Empty: the surface follows its bones only.
  SkinningMethod method = SkinningMethod::linear;
  bool has_normals = true;   ///< Whether normals are posed, if a mesh has them.
  bool has_tangents = true;  ///< Likewise for tangents.
  bool unit_length = false;  ///< Whether they are normalised; see VertexTarget::unit_length.
  ParallelFor parallel_for;  ///< Used by advance().
};

/// One mesh for drawing, after CharacterInstance::advance(). All spans are valid until the next
/// call that is not const.
struct PosedMesh {
  std::span<const Vec3f> positions;  ///< One per vertex; model space, metres.
  std::span<const Vec3f> normals;    ///< One per vertex, or empty.
  std::span<const Vec4f> tangents;   ///< One per vertex, or empty; w is the bitangent's sign.
  std::span<const Triangle> triangles;
  /// Ranges that the last advance() changed, to be uploaded; ascending and disjoint. A buffer that
  /// grew is listed as a whole.
  std::span<const IndexRange> dirty_vertices;
  std::span<const IndexRange> dirty_triangles;
  /// Vertices whose other attributes (texture coordinates, colours, weights) are new; read them
  /// from the model's mesh.
  std::span<const IndexRange> dirty_attributes;
};

/// One animated, soft, tearable copy of a character, with the posed vertices that an engine draws.
/// It owns the parts (TornModel, ParticleSet, SoftBody, SkinnedMesh, BonePalette, PosedBuffer) and
/// calls them in the right order: a call that tears updates the particles at once, and advance()
/// updates the meshes. Several instances may share one Character.
///
/// Results have the same bits as the same calls on the parts. One thread at a time per instance;
/// different instances are independent. A failing call changes nothing. See docs/frame.md.
class SUNDER_API CharacterInstance {
 public:
  /// @param character  satisfies validate_character(); kept.
  /// @return as the create() of TornModel, SkinnedMesh, ParticleSet and SoftBody.
  /// O(size of the character).
  static Result<CharacterInstance> create(std::shared_ptr<const Character> character,
                                          const CharacterInstanceOptions& options = {});
  ~CharacterInstance();
  CharacterInstance(CharacterInstance&&) noexcept;
  CharacterInstance& operator=(CharacterInstance&&) noexcept;

  // ---- Operations: each is the call of TornModel of its name, documented there. The particles
  // follow at once; the next advance() draws the effect. All return what TornModel returns; also
  // limit_exceeded if the particles cannot follow without enough memory, after which only a new
  // instance helps.

  Result<TearReport> tear(const ModelPose& pose, std::span<const Blade> stroke,
                          const TearOptions& options = {}, ChangeRecord* change = nullptr);
  Result<TearReport> cut(const ModelPose& pose, const PlaneCut& cut,
                         ChangeRecord* change = nullptr);
  Result<TearReport> drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change = nullptr);
  Result<DetachedPiece> detach(const ModelPose& pose, const PiecePlace& place,
                               const DetachOptions& options = {}, ChangeRecord* change = nullptr);
  Status undo(ChangeRecord* change = nullptr);
  Status redo(ChangeRecord* change = nullptr);
  /// As apply_operation(): any operation of a log. @param changes  optional; records are appended.
  Result<TearReport> apply(const Operation& operation,
                           std::vector<ChangeRecord>* changes = nullptr);

  /// As TornModel::compact(). All other parts are made anew: the next advance() draws everything,
  /// and tissue is at rest, without the forces, holds, colliders and materials that were set.
  Result<CompactMaps> compact();

  // ---- A stroke over several frames: each is the call of TearStroke of its name. At most one
  // stroke at a time; other operations are refused meanwhile.

  Status begin_stroke(const ModelPose& pose, const Blade& blade, const TearOptions& options = {},
                      const StrokeSampling& sampling = {});
  Result<TearReport> extend_stroke(const ModelPose& pose, const Blade& blade, double seconds = 0.0,
                                   ChangeRecord* change = nullptr);
  Result<TearReport> end_stroke(ChangeRecord* change = nullptr);
  Status cancel_stroke(ChangeRecord* change = nullptr);

  /// As sunder::tear_overstretched(), in the pose of the last advance().
  /// @return also invalid_argument for an instance that is not soft, or before the first advance().
  Result<ForceTearingReport> tear_overstretched(const ForceTearingOptions& options = {},
                                                std::vector<ChangeRecord>* changes = nullptr);

  /// A refit of the weights of torn vertices, to be run on any thread.
  /// @return as RefitJob::create().
  Result<RefitJob> begin_refit(const WeightsOperation& wanted);
  /// @return as RefitJob::swap_in().
  Result<WeightReport> swap_in(const RefitJob& job, ChangeRecord* change = nullptr);

  /// Advances to a pose: steps the soft body, updates the meshes that were torn since the last
  /// call, and poses every vertex that changed. O(bones + vertices that moved + changes by tears),
  /// and the step of the soft body. Without a tear, no allocation once warm.
  ///
  /// @param pose     one matrix per bone, one weight per morph weight.
  /// @param seconds  since the last call, >= 0; the time step of the soft body.
  /// @return size_mismatch, index_out_of_range, non_finite_value, invalid_argument (nothing is
  ///         changed); limit_exceeded without enough memory: do not draw mesh() until a later call
  ///         succeeds; the time may have passed for the soft body.
  Status advance(const ModelPose& pose, double seconds);

  /// One mesh of model().character(), unchecked. Empty before the first advance(), and between an
  /// operation that changed it and the next advance().
  [[nodiscard]] PosedMesh mesh(std::uint32_t mesh) const;

  /// The torn model, read-only; it changes through the calls above.
  [[nodiscard]] const TornModel& model() const;
  /// The pose of the last advance(); empty before it.
  [[nodiscard]] const ModelPose& pose() const;
  /// The soft body, for forces, holds, colliders and materials; advance() steps it. Null for an
  /// instance that is not soft.
  [[nodiscard]] SoftBody* body();
  [[nodiscard]] const SoftBody* body() const;
  /// Null for an instance that is not soft.
  [[nodiscard]] const ParticleSet* particles() const;

 private:
  struct State;
  explicit CharacterInstance(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
