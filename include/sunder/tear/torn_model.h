#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/operation.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/report.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

/// What the operations on a model may append, counted over all that are done and not taken back.
/// With a fixed capacity the memory is there from the start: an operation that finds no room
/// changes nothing and returns capacity_exceeded. A cut across n faces appends about 2 n vertices
/// and triangles.
struct TornCapacity {
  std::uint32_t vertices = 0;   ///< Each mesh gets room for so many.
  std::uint32_t triangles = 0;  ///< Likewise.
  std::uint32_t operations = 0;

  /// All zero: the model grows as needed, and an operation allocates where it has to grow.
  [[nodiscard]] constexpr bool is_fixed() const {
    return vertices > 0 || triangles > 0 || operations > 0;
  }

  bool operator==(const TornCapacity&) const = default;
};

/// For each mesh where its elements came from: old_from_new[new] = old. Ascending: order is kept.
struct CompactMaps {
  struct OfMesh {
    std::vector<std::uint32_t> vertex_old_from_new;
    std::vector<std::uint32_t> triangle_old_from_new;
  };
  std::vector<OfMesh> meshes;
};

namespace tear {
struct Surface;
}

class TornModel;
struct ParentBlends;
struct WeightErrors;
// Friends, which say what they are in headers of their own: <sunder/tear/parent_blends.h>,
// <sunder/tear/weight_errors.h>.
SUNDER_API ParentBlends parent_blends(const TornModel& model, std::uint32_t mesh);
SUNDER_API Result<WeightErrors> measure_weight_errors(const TornModel& model,
                                                      std::uint32_t first_operation,
                                                      std::uint32_t operation_count,
                                                      std::span<const ModelPose> poses);

/// A character that can be torn. It keeps the source, the torn meshes, and the topology of their
/// surface.
class SUNDER_API TornModel {
 public:
  /// @param source  satisfies validate_character(); kept. The model starts as a copy of it.
  /// @param capacity  what operations may append; by default the model grows.
  /// @return the first fault of the source; empty_input for none; limit_exceeded above 700 million
  /// triangles, or without enough
  ///         memory. O(size of the source and of the capacity).
  static Result<TornModel> create(std::shared_ptr<const Character> source,
                                  const TornCapacity& capacity = {});

  TornModel(TornModel&&) noexcept;
  TornModel& operator=(TornModel&&) noexcept;
  ~TornModel();

  /// Tears the posed surface along a stroke. Without width it opens and the two lips coincide until
  /// something pulls them apart; with a width, the band of surface that a blade of that thickness
  /// passes is removed.
  ///
  /// Each two neighbouring blades sweep a segment, cut by one plane: through the tip where the tear
  /// stands (or the first blade's hit) and the second blade. The tear enters where the sweep first
  /// meets the surface, on the layer nearest to the blade's base, and follows that layer, face to
  /// face, while the blade reaches it. Its two ends are closed. See docs/tear.md.
  ///
  /// @param pose    one matrix a bone, all finite; morph weights as the character's.
  /// @param stroke  at least two blades, model space; each longer than zero; neighbours turned by
  /// less than 90 degrees.
  /// @param change  written where given: what an engine has to mirror.
  /// @return what was done; a stroke that misses is a success with runs = 0. size_mismatch,
  /// non_finite_value, invalid_argument
  ///         (index = the blade), limit_exceeded (out of memory), capacity_exceeded (no room left
  ///         in a model of fixed capacity): the model is as it was, bit for bit.
  ///
  /// O(faces crossed), and where the tear enters O(log faces). Allocates where a model that grows
  /// has to grow, for pieces that come free, with a width, walls or all layers, and where weights
  /// are other than `barycentric` with all influences. The first operation also builds what entries
  /// are looked up in: O(faces).
  Result<TearReport> tear(const ModelPose& pose, std::span<const Blade> stroke,
                          const TearOptions& options = {}, ChangeRecord* change = nullptr);

  /// Cuts the posed surface by a plane, every layer of it. Lips coincide, as those of a tear.
  /// @return as tear(). O(faces crossed), and O(all faces) where pieces come free.
  Result<TearReport> cut(const ModelPose& pose, const PlaneCut& cut,
                         ChangeRecord* change = nullptr);

  /// Removes the posed surface inside a bore, every layer of it.
  /// @return as tear(). O(faces crossed and removed).
  Result<TearReport> drill(const ModelPose& pose, const Bore& bore, ChangeRecord* change = nullptr);

  /// Takes back the newest operation, or does again the one that was taken back last: every array
  /// as it was then, bit for bit. Any operation forgets what could be done again. O(what the
  /// operation changed).
  /// @param change  written where given. Of lips and rims, undo() tells none, and redo() what the
  /// operation told.
  /// @return not_found where there is none.
  Status undo(ChangeRecord* change = nullptr);
  Status redo(ChangeRecord* change = nullptr);
  [[nodiscard]] std::uint32_t undo_count() const;
  [[nodiscard]] std::uint32_t redo_count() const;

  /// How operations weigh the points that they make, where they do not say: `barycentric`, all
  /// influences, unless this was called. What was made before keeps what it has; see reweigh().
  Status set_weights(const WeightOptions& options);
  [[nodiscard]] const WeightOptions& weights() const;
  /// Gives the points that earlier operations made other weights, from their births, and the same
  /// to every vertex that shares them. An operation of its own: it is in the history, and undo()
  /// takes back no more than it. Where tears run does not depend on it. `refit` fits here and now;
  /// to fit beside the frame see RefitJob.
  ///
  /// @param change  written where given: vertices that are dirty.
  /// @return not_found where there are no such operations; what the pose or the poses of a refit
  /// are refused for; unsupported_feature
  ///         for a coupled refit that was not built. O(vertices appended since the first of them),
  ///         and what a refit takes.
  Result<WeightReport> reweigh(const WeightsOperation& wanted, ChangeRecord* change = nullptr);
  /// What the weights of a vertex were made by: `barycentric` for one of the source, for one in a
  /// corner of its birth triangle, and for one of a wall or cap that is not on its rim. Unchecked.
  [[nodiscard]] WeightPolicy weight_policy(std::uint32_t mesh, std::uint32_t vertex) const;
  /// The `exact` vertices of a mesh: what VertexSource::per_influence takes. In the mesh itself,
  /// and in files, they have their barycentric weights. Unchecked. Valid until the next call that
  /// changes the model.
  [[nodiscard]] const InfluencePositions& influence_positions(std::uint32_t mesh) const;
  /// Where a vertex' own begin among those; kNone for one that is not `exact`. Unchecked.
  [[nodiscard]] std::uint32_t influence_place(std::uint32_t mesh, std::uint32_t vertex) const;

  /// A number that the newest operation has and no other, of any model; kept by undo() and redo().
  /// 0: nothing is done.
  [[nodiscard]] std::uint64_t newest_operation() const;
  /// Whether a TearStroke is under way.
  [[nodiscard]] bool is_in_stroke() const;

  /// What was done and not taken back, oldest first, with the poses' bone matrices in full: played
  /// on the source it gives this model again, bit for bit.
  [[nodiscard]] std::vector<Operation> history() const;

  /// Drops retired triangles and unused vertices. The model begins anew with the result as its
  /// source: births start over, and there is nothing to undo. O(size of the model).
  /// @return where each element came from; limit_exceeded (out of memory): the model is as it was.
  Result<CompactMaps> compact();

  /// One number for all bits of the model as it stands: equal models have equal digests on every
  /// machine. O(size of the model).
  [[nodiscard]] std::uint64_t digest() const;

  /// The model as it stands. Meshes have those vertices and triangles of the source first, under
  /// their numbers. A torn mesh carries the attribute `_TEARSIDE`, in which the two lips of a tear
  /// differ.
  [[nodiscard]] const Character& character() const;
  [[nodiscard]] const Character& source() const;

  /// Surface points are shared by the vertices that a UV seam or hard edge duplicates, over all
  /// meshes.
  [[nodiscard]] std::uint32_t point_count() const;
  /// The topology as it stands: half-edges between points. Valid until the next call that changes
  /// the model.
  [[nodiscard]] const tear::Surface& surface() const;
  /// The point at a corner (0, 1, 2) of a triangle of a mesh. Unchecked.
  [[nodiscard]] std::uint32_t point_at(std::uint32_t mesh, std::uint32_t triangle,
                                       std::uint32_t corner) const;
  /// Where an appended vertex came from; vertices of the source have no birth. A copy of one lies
  /// in a corner of its birth triangle. Unchecked.
  [[nodiscard]] Birth birth(std::uint32_t mesh, std::uint32_t vertex) const;
  /// The triangle of the source that a triangle is a part of; from the source's triangle count up:
  /// that of a wall or cap, see fillings(). Unchecked.
  [[nodiscard]] std::uint32_t source_triangle(std::uint32_t mesh, std::uint32_t triangle) const;
  /// Triangles of walls and caps as they were made: their vertices. Births and source_triangle()
  /// number them after the source's.
  [[nodiscard]] std::span<const Triangle> fillings(std::uint32_t mesh) const;

 private:
  friend class TearStroke;
  friend class RefitJob;
  friend Result<WeightErrors> measure_weight_errors(const TornModel&, std::uint32_t, std::uint32_t,
                                                    std::span<const ModelPose>);
  friend ParentBlends parent_blends(const TornModel&, std::uint32_t);
  struct State;
  explicit TornModel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Does what an operation says: poses are looked up in the model's skeleton and clips.
/// @param changes  appended where given: one record for each step, in order. Undo and redo of
/// several operations, and a stroke in
///                 several poses, are several steps.
/// @return as the operation's own call; not_found for a clip or bone that the character does not
/// have, and for undo and redo of more
///         than there is (nothing is taken back then).
SUNDER_API Result<TearReport> apply_operation(TornModel& model, const Operation& operation,
                                              std::vector<ChangeRecord>* changes = nullptr);

}  // namespace sunder
