#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/report.h>
#include <sunder/tear/torn_asset.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

/// The previous index of each element, per mesh: old_from_new[new] = old, ascending.
struct CompactMaps {
  struct OfMesh {
    std::vector<std::uint32_t> vertex_old_from_new;
    std::vector<std::uint32_t> triangle_old_from_new;
  };
  std::vector<OfMesh> meshes;
};

namespace tear {
struct ModelAccess;
struct Surface;
}  // namespace tear

class TornModel;
struct ParentBlends;
struct WeightErrors;
// Friends of TornModel, documented in <sunder/tear/torn_weights.h>.
SUNDER_API Result<ParentBlends> parent_blends(const TornModel& model, std::uint32_t mesh);
SUNDER_API Result<WeightErrors> measure_weight_errors(const TornModel& model,
                                                      std::uint32_t first_operation,
                                                      std::uint32_t operation_count,
                                                      std::span<const ModelPose> poses);
// A friend of TornModel, documented in <sunder/tear/detached_piece.h>.
struct DetachedPiece;
struct DetachOptions;
SUNDER_API Result<DetachedPiece> detach(TornModel& model, const ModelPose& pose,
                                        const PiecePlace& place, const DetachOptions& options,
                                        ChangeRecord* change);

// A friend of TornModel, documented below.
SUNDER_API Result<TearReport> suture(TornModel& model, const ModelPose& pose, const Suture& suture,
                                     ChangeRecord* change = nullptr);

/// A character that can be torn: the source, the torn meshes, and the topology of their surface.
/// Use a model on one thread at a time; different models are independent. Accessors return
/// references that are valid until the next call that changes the model.
class SUNDER_API TornModel {
 public:
  /// @param source  must satisfy validate_character(); kept. The model starts as a copy of it.
  /// @param capacity  what operations may append; by default the model grows as needed.
  /// @return the first fault of the source; empty_input if it is null; limit_exceeded above 700
  ///         million triangles or out of memory. O(size of the source and of the capacity).
  static Result<TornModel> create(std::shared_ptr<const Character> source,
                                  const TornCapacity& capacity = {});
  /// A model that shares an asset, which makes it cheap to have thousands. Until its first
  /// operation, character() is the asset's own.
  /// @return empty_input if the asset is null; limit_exceeded as above. O(1); a model of fixed
  ///         capacity allocates nothing later if the asset has an idle workspace of its capacity.
  static Result<TornModel> create(std::shared_ptr<const TornAsset> asset,
                                  const TornCapacity& capacity = {});

  TornModel(TornModel&&) noexcept;
  TornModel& operator=(TornModel&&) noexcept;
  ~TornModel();

  /// Tears the posed surface along a stroke. Without a width the surface opens into two lips that
  /// coincide; with a width the band that the blade passes is removed. The tear enters where the
  /// sweep first meets the surface and follows that layer, face to face. docs/tear.md describes
  /// the method.
  /// @param pose    one finite matrix per bone; morph weights as many as the character's.
  /// @param stroke  at least two blades in model space, each longer than zero; neighbours differ
  ///                by less than 90 degrees.
  /// @param change  optional; written: what an engine has to mirror.
  /// @return what was done; runs = 0 if the stroke missed. On size_mismatch, non_finite_value,
  ///         invalid_argument (index: the blade), limit_exceeded (out of memory) and
  ///         capacity_exceeded the model is unchanged, bit for bit.
  /// O(faces crossed + log faces); the first operation also builds a search tree in O(faces).
  /// Allocates to grow, for pieces, widths, walls and all layers, and for weights other than
  /// `barycentric`.
  Result<TearReport> tear(const ModelPose& pose, std::span<const Blade> stroke,
                          const TearOptions& options = {}, ChangeRecord* change = nullptr);

  /// Cuts all layers of the posed surface by a plane. The lips coincide, like those of a tear.
  /// @return as tear(). O(faces crossed + log faces); the first call also builds the cells by which
  ///         pieces are named, in O(faces).
  Result<TearReport> cut(const ModelPose& pose, const PlaneCut& cut,
                         ChangeRecord* change = nullptr);

  /// Removes all layers of the posed surface inside a bore.
  /// @return as tear(). O(faces crossed and removed).
  Result<TearReport> drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change = nullptr);

  /// Closes wounds: lips that lie on one another in bind space become one surface again, walls and
  /// caps between them go. Where one lip has a point that the other lacks, because another wound
  /// crosses it, both have it afterwards. The result lies where the untorn surface does, as far as
  /// the weights of the points do; scars_of() lists its edges. docs/tear.md describes the method.
  /// @return as tear(); runs: the joined runs of edges, 0 if there was nothing to close; blocked:
  ///         edges of lips that could not be joined, whose walls and caps are gone too. O(triangles
  ///         that operations changed), and O(lips) for each place; allocates.
  Result<TearReport> weld(const ModelPose& pose, const Weld& weld, ChangeRecord* change = nullptr);

  /// Lists and measures the connected component that now contains the triangle that names a piece,
  /// in the pose of the most recent operation or call of a stroke.
  /// @return not_found if that triangle was removed since, or if the model is as it was made;
  ///         index_out_of_range if there is no such triangle; limit_exceeded (out of memory).
  ///         O(triangles of the piece), and a bit per triangle of the model. Allocates.
  [[nodiscard]] Result<PieceDescription> describe_piece(const TornPiece& piece) const;

  /// `undo` reverts the most recent operation; `redo` reapplies the operation most recently
  /// undone. Both restore every array bit for bit. A new operation clears the redo stack. O(what
  /// the operation changed).
  /// @param change  optional; written. It has no lips and rims after undo(), and those of the
  ///                operation after redo().
  /// @return not_found if there is no such operation.
  Status undo(ChangeRecord* change = nullptr);
  Status redo(ChangeRecord* change = nullptr);
  [[nodiscard]] std::uint32_t undo_count() const;
  [[nodiscard]] std::uint32_t redo_count() const;

  /// Sets how points created by operations without weight options are skinned; initially
  /// `barycentric` with all influences. Existing points are unchanged; see reweigh().
  Status set_weights(const WeightOptions& options);
  [[nodiscard]] const WeightOptions& weights() const;
  /// Assigns new weights, computed from births, to points that earlier operations made and to all
  /// vertices that share them. This is an operation of its own in the history. The paths of tears
  /// do not depend on weights. `refit` is computed before the call returns; RefitJob computes it
  /// in the background.
  /// @param change  optional; written: the dirty vertices.
  /// @return not_found if there are no such operations; the errors of the pose or of the poses of
  ///         a refit; unsupported_feature for a coupled refit without Ceres. O(vertices appended
  ///         since the first of the operations), in addition to the refit.
  Result<WeightReport> reweigh(const WeightsOperation& wanted, ChangeRecord* change = nullptr);
  /// The policy that computed the weights of a vertex. `barycentric` for vertices of the source,
  /// in a corner of their birth triangle, and inside walls and caps. Indices are unchecked.
  [[nodiscard]] WeightPolicy weight_policy(std::uint32_t mesh, std::uint32_t vertex) const;
  /// The `exact` vertices of a mesh, as VertexSource::per_influence takes them. In the mesh itself
  /// and in files they have barycentric weights. The index is unchecked.
  [[nodiscard]] const InfluencePositions& influence_positions(std::uint32_t mesh) const;
  /// Index of a vertex's first entry in influence_positions(); kNone if it is not `exact`. Indices
  /// are unchecked.
  [[nodiscard]] std::uint32_t influence_place(std::uint32_t mesh, std::uint32_t vertex) const;

  /// A number that identifies the most recent operation among those of all models. undo() and
  /// redo() keep it. 0 if no operation is done.
  [[nodiscard]] std::uint64_t newest_operation() const;
  /// Whether a TearStroke is in progress.
  [[nodiscard]] bool is_in_stroke() const;

  /// The operations that are done and not undone, oldest first, with all bone matrices of their
  /// poses. Applied to the source they reproduce this model, bit for bit.
  /// @return limit_exceeded: out of memory. O(size of the operations), allocates.
  [[nodiscard]] Result<std::vector<Operation>> history() const;
  /// The operations that redo() would reapply, the next one first. @return as history().
  [[nodiscard]] Result<std::vector<Operation>> undone_operations() const;

  /// Removes retired triangles and unused vertices. The result becomes the model's source: births
  /// start over and there is nothing to undo. O(size of the model).
  /// @return where each element came from; limit_exceeded (out of memory): the model is unchanged.
  Result<CompactMaps> compact();

  /// Stores the state in a compact form, in proportion to what was torn, and gives the workspace
  /// back to the asset. For a model that will not be torn for a while. The next operation unpacks
  /// the state, and so do accessors of the torn character, surface and births; references that
  /// they returned before are invalid. A model made from a character keeps its workspace.
  /// @return invalid_argument during a stroke; limit_exceeded: out of memory, nothing changes.
  ///         O(appended and changed elements), allocates.
  Status pack();
  /// Takes a workspace, so that nothing else need do it. An accessor ends the program if there is
  /// no memory for one. Reentrant.
  /// @return limit_exceeded: out of memory. O(appended and changed elements), and O(size of the
  ///         source) if the asset has no idle workspace.
  Status unpack() const;
  /// Whether the model has no workspace.
  [[nodiscard]] bool is_packed() const;
  /// O(arrays and operations). Reentrant while the model is not changed.
  [[nodiscard]] TornMemory memory_bytes() const;

  /// A hash of all bits of the model: equal models have equal digests on every machine. O(size of
  /// the model).
  [[nodiscard]] std::uint64_t digest() const;

  /// The model in its current state. Each mesh has the vertices and triangles of the source first,
  /// with the same indices. A torn mesh has the attribute `_TEARSIDE`, which differs between the
  /// two lips of a tear.
  [[nodiscard]] const Character& character() const;
  [[nodiscard]] const Character& source() const;

  /// Number of surface points. A point is shared by the vertices, of all meshes, that a UV seam or
  /// a hard edge duplicates.
  [[nodiscard]] std::uint32_t point_count() const;
  /// The current topology: half-edges between points.
  [[nodiscard]] const tear::Surface& surface() const;
  /// The point at a corner (0, 1, 2) of a triangle of a mesh. Indices are unchecked.
  [[nodiscard]] std::uint32_t point_at(std::uint32_t mesh, std::uint32_t triangle,
                                       std::uint32_t corner) const;
  /// The birth of an appended vertex; vertices of the source have none. A duplicate of one was born
  /// in a corner of its triangle. Indices are unchecked.
  [[nodiscard]] Birth birth(std::uint32_t mesh, std::uint32_t vertex) const;
  /// The source triangle that a triangle is a part of. Values from the source's triangle count on
  /// denote triangles of walls and caps; see fillings(). Indices are unchecked.
  [[nodiscard]] std::uint32_t source_triangle(std::uint32_t mesh, std::uint32_t triangle) const;
  /// Vertices of the triangles of walls and caps as they were created. Births and source_triangle()
  /// number these triangles after those of the source.
  [[nodiscard]] std::span<const Triangle> fillings(std::uint32_t mesh) const;

 private:
  friend class TearStroke;
  friend class OperationJob;
  friend class RefitJob;
  friend class TornAsset;
  friend struct tear::ModelAccess;
  friend Result<WeightErrors> measure_weight_errors(const TornModel&, std::uint32_t, std::uint32_t,
                                                    std::span<const ModelPose>);
  friend Result<ParentBlends> parent_blends(const TornModel&, std::uint32_t);
  friend Result<DetachedPiece> detach(TornModel&, const ModelPose&, const PiecePlace&,
                                      const DetachOptions&, ChangeRecord*);
  friend Result<TearReport> suture(TornModel&, const ModelPose&, const Suture&, ChangeRecord*);
  struct State;
  struct Instance;
  /// Points to the state in the workspace. A packed model is unpacked first.
  class StatePointer {
   public:
    State& operator*() const noexcept { return *get(); }
    State* operator->() const noexcept { return get(); }
    [[nodiscard]] State* get() const noexcept;

    std::unique_ptr<Instance> instance;
  };
  explicit TornModel(std::unique_ptr<Instance> instance);
  /// The state; null if nothing was torn yet.
  [[nodiscard]] const State* torn_state() const;

  StatePointer state_;
};

/// Edges that were welded, as pairs of surface points, in the order of the welds. A later tear may
/// have opened an edge again, or put points on it; a later weld may have made a point one with an
/// older one: then it has no face. Valid until the next change of the model; empty without welds.
SUNDER_API std::span<const std::array<std::uint32_t, 2>> scars_of(const TornModel& model);

/// Name of the custom attribute of mark_scars().
inline constexpr const char* kScarAttribute = "_SCAR";

/// Marks the points of edges that were welded, for files and shaders: gives meshes that have some
/// the attribute `_SCAR`, 1 at their vertices and elsewhere 0, or what the source has.
/// O(vertices + triangles)
/// @param character  with the vertices and triangles of model.character(), such as a copy of it.
SUNDER_API void mark_scars(const TornModel& model, Character& character);

/// Sews wounds: ties threads between points of lips that lie on one another in bind space, evenly
/// along each wound. The surface stays as it is; SoftBody pulls the lips together.
/// @return as TornModel::tear(); runs: the wounds that were sewn, 0 if there was nothing to sew;
///         threads_of() has their threads. O(triangles that operations changed), and O(lips) for
///         each place; allocates.
SUNDER_API Result<TearReport> suture(TornModel& model, const ModelPose& pose, const Suture& suture,
                                     ChangeRecord* change);

/// All threads, in the order in which they were tied. Valid until the next change of the model;
/// empty without sutures.
SUNDER_API std::span<const SutureThread> threads_of(const TornModel& model);

/// A vertex of a mesh; kNone: none.
struct MeshVertex {
  std::uint32_t mesh = kNone, vertex = kNone;
};

/// One of the vertices at a surface point, such as the end of a thread; none if the point has no
/// face any more. The index is unchecked. O(1)
SUNDER_API MeshVertex vertex_at(const TornModel& model, std::uint32_t point);

/// Applies one operation to a model; poses are looked up in the model's skeleton and clips.
///
/// @param changes  optional; one record per step is appended, in order. Undo and redo of several
///         operations, and strokes in several poses, have several steps.
/// @return as the operation's own call; not_found for an unknown clip or bone, and for more undos
///         or redos than there are (then none is done). A failing stroke changes nothing.
SUNDER_API Result<TearReport> apply_operation(TornModel& model, const Operation& operation,
                                              std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
