#pragma once

#include <sunder/core/parallel_for.h>
#include <sunder/particles/force_tearing.h>
#include <sunder/scene/character_asset.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/operation_job.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/wound_mask.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

namespace scene {
class InstanceReplay;
}

struct PieceTissue;

/// A triangle to be written into an index buffer.
struct TriangleWrite {
  std::uint32_t place = 0;  ///< Index of the triangle in the index buffer.
  Triangle triangle = {};
};

/// One mesh for drawing, after CharacterInstance::draw(), with what changed since an epoch. All
/// spans are valid until the next call on the instance that is not const.
struct PosedMesh {
  std::uint64_t epoch = 0;  ///< To be passed to the next call of mesh().
  /// Not empty: the index buffer starts anew as a copy of these, the triangles of the asset.
  std::span<const Triangle> initial_triangles;
  std::span<const Vec3f> positions;     ///< One per vertex; model space, metres.
  std::span<const Vec3f> normals;       ///< One per vertex, or empty.
  std::span<const Vec4f> tangents;      ///< One per vertex, or empty; w is the bitangent's sign.
  std::span<const DrawRange> ranges;    ///< At most two per submesh: one draw call each.
  std::uint32_t triangle_capacity = 0;  ///< Size that the index buffer needs, in triangles.
  /// Vertices to be uploaded; ascending and disjoint. A buffer that grew is listed as a whole.
  std::span<const IndexRange> dirty_vertices;
  /// Vertices whose other attributes (texture coordinates, colours, weights) are new; read them
  /// from the model's mesh. Ascending and disjoint.
  std::span<const IndexRange> dirty_attributes;
  /// Triangles to be written into the index buffer, in order.
  std::span<const TriangleWrite> triangle_writes;
};

/// One animated, soft, tearable instance of a CharacterAsset, with the posed vertices that an
/// engine draws. It owns the parts (TornModel, ParticleSet, SoftBody, BonePalette, PosedBuffer),
/// creates them when they are needed first, and calls them in the right order: a call that tears
/// updates the particles at once; draw() updates the meshes.
///
/// Results have the same bits as the same calls on the parts. One thread at a time per instance;
/// different instances are independent, also those of one asset. A failing call changes nothing.
/// See docs/frame.md.
class SUNDER_API CharacterInstance {
 public:
  /// @return empty_input without an asset; limit_exceeded: out of memory. O(meshes + bones).
  static Result<CharacterInstance> create(std::shared_ptr<const CharacterAsset> asset,
                                          const TornCapacity& capacity = {});
  /// An instance that shares its asset with no other one. @return also as CharacterAsset::create().
  static Result<CharacterInstance> create(std::shared_ptr<const Character> character,
                                          const CharacterAssetOptions& options = {},
                                          const TornCapacity& capacity = {});
  ~CharacterInstance();
  CharacterInstance(CharacterInstance&&) noexcept;
  CharacterInstance& operator=(CharacterInstance&&) noexcept;

  /// Creates the torn model and the soft body now, with all memory that the first operation needs,
  /// which it would do otherwise. O(size of the character). @return limit_exceeded: out of memory.
  Status prepare_to_tear();

  /// As TornModel::pack(): for an instance that will not be torn for a while. A Scene does it.
  Status pack();

  // ---- Operations: each is the call of TornModel of its name, documented there. The particles
  // follow at once; the next draw() shows the effect. All return what TornModel returns; also
  // limit_exceeded if the particles cannot follow without enough memory, after which only a new
  // instance helps.

  Result<TearReport> tear(const ModelPose& pose, std::span<const Blade> stroke,
                          const TearOptions& options = {}, ChangeRecord* change = nullptr);
  Result<TearReport> cut(const ModelPose& pose, const PlaneCut& cut,
                         ChangeRecord* change = nullptr);
  Result<TearReport> drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change = nullptr);
  Result<TearReport> weld(const ModelPose& pose, const Weld& weld, ChangeRecord* change = nullptr);
  Result<TearReport> suture(const ModelPose& pose, const Suture& suture,
                            ChangeRecord* change = nullptr);
  /// @param tissue  optional; written, empty without a soft body: how the piece moves.
  Result<DetachedPiece> detach(const ModelPose& pose, const PiecePlace& place,
                               const DetachOptions& options = {}, ChangeRecord* change = nullptr,
                               PieceTissue* tissue = nullptr);
  Status undo(ChangeRecord* change = nullptr);
  Status redo(ChangeRecord* change = nullptr);
  /// As apply_operation(): any operation of a log. @param changes  optional; records are appended.
  Result<TearReport> apply(const Operation& operation,
                           std::vector<ChangeRecord>* changes = nullptr);

  /// As TornModel::compact(). The instance has an asset of its own afterwards, and all parts are
  /// made anew: tissue is at rest, without the forces, holds, colliders and materials that were
  /// set. Start from the index buffers of the new asset.
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
  /// @return also invalid_argument for an instance without a soft body, or before the first
  ///         advance().
  Result<ForceTearingReport> tear_overstretched(const ForceTearingOptions& options = {},
                                                std::vector<ChangeRecord>* changes = nullptr);

  /// A refit of the weights of torn vertices, to be run on any thread.
  /// @return as RefitJob::create().
  Result<RefitJob> begin_refit(const WeightsOperation& wanted);
  /// A large operation, to be run on any thread, with what particles and drawing need afterwards;
  /// the newest one only. Until it is swapped in, lips do not go on to part. @return as
  /// OperationJob::create().
  Result<OperationJob> begin_operation(const Operation& operation);
  /// The same for a detachment; the job makes the piece.
  Result<OperationJob> begin_detach(const DetachOperation& operation,
                                    const DetachOptions& options = {});
  /// @param tissue  optional; as in detach(), for its job.
  /// @return as the swap_in() of the job.
  Result<TearReport> swap_in(const OperationJob& job, ChangeRecord* change = nullptr,
                             PieceTissue* tissue = nullptr);
  Result<WeightReport> swap_in(const RefitJob& job, ChangeRecord* change = nullptr);

  /// Advances to a pose and steps the soft body. O(bones), and the step. No allocation once warm.
  ///
  /// @param pose     one matrix per bone, one weight per morph weight.
  /// @param seconds  since the last call, >= 0; the time step of the soft body.
  /// @param settled_points  as in SoftBody::step().
  /// @return size_mismatch, index_out_of_range, non_finite_value, invalid_argument (nothing is
  ///         changed); limit_exceeded without enough memory: the time may have passed for the soft
  ///         body.
  Status advance(const ModelPose& pose, double seconds, std::uint32_t settled_points = 500);

  /// Poses every vertex that changed since the last call. Leave it out for an instance that nobody
  /// sees. O(vertices that moved + changes by tears); O(meshes) if nothing moved. Without a tear,
  /// no allocation once warm.
  ///
  /// @return invalid_argument before the first advance(); limit_exceeded without enough memory, and
  ///         capacity_exceeded if a target of set_target() is too small: do not use mesh() until a
  ///         later call succeeds.
  Status draw(const ParallelFor& parallel_for = {});
  /// Continues to separate the particles at lips, as ParticleSet::settle(), in place of advance().
  /// @return whether work remains.
  bool settle(std::uint32_t points);

  /// Lets draw() write a mesh into memory of the caller, such as a mapped vertex buffer, with room
  /// for `target.vertex_count` vertices. Attributes without data are not computed. Without data at
  /// all the instance has memory of its own again. The mesh index is unchecked.
  /// @return limit_exceeded: out of memory.
  Status set_target(std::uint32_t mesh, const VertexTarget& target);

  /// One mesh after draw(), unchecked.
  /// @param seen  the epoch up to which the caller's buffers are up to date; 0: there are none yet.
  ///              Any number of callers may keep buffers, and skip frames.
  /// Empty before the first draw(), and between an operation that changed the mesh and the next
  /// draw(). O(changes since then).
  [[nodiscard]] PosedMesh mesh(std::uint32_t mesh, std::uint64_t seen = 0);

  /// Keeps the wounds of a mesh in a texture from now on: every operation, undo and redo paints
  /// what it changes. Called again, it begins anew. compact() ends it, and snapshots do not keep
  /// it.
  /// @return as WoundMask::create().
  Status begin_wound_mask(std::uint32_t mesh, const WoundMaskOptions& options = {});
  /// Drops it, if there is one.
  void end_wound_mask(std::uint32_t mesh);
  /// A mask, and the texels that may have changed since the last call.
  struct PaintedWounds {
    const WoundMask* mask = nullptr;  ///< Valid until the next call that is not const.
    TexelRectangle changed;
  };
  /// @return not_found: the mesh has none; limit_exceeded: out of memory. O(1), but after an
  ///         operation for which memory did not suffice, which is made up for.
  Result<PaintedWounds> wound_mask(std::uint32_t mesh);
  /// The mask alone, for its channels; the texels that changed stay to be told. @return as above.
  Result<const WoundMask*> peek_wound_mask(std::uint32_t mesh);

  [[nodiscard]] const std::shared_ptr<const CharacterAsset>& asset() const;
  /// The character in its current state: that of the asset, or of model().
  [[nodiscard]] const Character& character() const;
  /// The torn model, read-only; it changes through the calls above. Null before the first operation
  /// or prepare_to_tear().
  [[nodiscard]] const TornModel* model() const;
  /// The pose of the last advance(); empty before it.
  [[nodiscard]] const ModelPose& pose() const;
  /// The soft body, for forces, holds, colliders and materials; advance() steps it. Null like
  /// model(), and if the asset is not soft.
  [[nodiscard]] SoftBody* body();
  [[nodiscard]] const SoftBody* body() const;
  /// Null like body().
  [[nodiscard]] const ParticleSet* particles() const;
  /// How tissue displaces the vertices of a mesh, for queries (ContactOptions) and shaders; nothing
  /// is moved without a soft body. Valid until the next call that is not const. Unchecked.
  [[nodiscard]] VertexDisplacements displacements(std::uint32_t mesh);
  /// The state of soft tissue, as plain data; see ParticleSet::save() and SoftBody::save().
  struct TissueState {
    StateArrays particles, body;
  };
  /// @return invalid_argument without a soft body; as those calls. O(particles + points),
  /// allocates.
  [[nodiscard]] Result<TissueState> tissue() const;
  /// Sets the state of soft tissue to one that was kept when the model was as it is now.
  /// @return as ParticleSet::restore() and SoftBody::restore(); nothing is changed then.
  Status restore_tissue(const TissueState& state);

  [[nodiscard]] bool is_in_stroke() const;
  /// The number of vertices that the last draw() posed.
  [[nodiscard]] std::uint32_t drawn_vertices() const;
  /// Memory of this instance, without its asset. O(meshes).
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Lets a soft instance of a piece, which was not advanced yet, move on as the piece did.
  /// @return invalid_argument without a soft body; as SoftBody::inherit_motion_from().
  Status inherit_motion(const DetachedPiece& piece, const PieceTissue& tissue);
  /// Whether draw() has something to do: an operation, another pose, or tissue that moved.
  [[nodiscard]] bool needs_draw() const;
  /// Whether advance() has something to do in an unchanged pose: tissue is awake, or was changed.
  [[nodiscard]] bool needs_step() const;
  /// Whether settle() has something to do.
  [[nodiscard]] bool needs_settling() const;

 private:
  friend class scene::InstanceReplay;
  struct State;
  explicit CharacterInstance(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
