#pragma once

#include <sunder/core/index.h>
#include <sunder/operation/operation.h>

#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "tear/surface/opened_borders.h"
#include "tear/surface/surface_editor.h"
#include "tear/surface/weight_change.h"

namespace sunder::tear {

/// The operations that are done, and the redo stack. Dropped entries keep their memory for later
/// ones.
class History {
 public:
  struct Entry {
    Operation operation;
    EditLog::Mark begin;
    SurfaceEditor::Redo redo;  ///< For an operation that was undone.
    /// For a WeightsOperation: the weights that undo and redo exchange with those of the model.
    WeightChange weights;
    /// Unique among the entries of all models; assigned by push().
    std::uint64_t serial = 0;
    /// Ranges in the borders of all entries; assigned by push().
    IndexRange lips, rim_points;

    /// The operation as a `Kind`, to be written. One of another kind is replaced; the memory of
    /// its pose is kept, and that of a stroke until the entry holds a stroke again. A stroke keeps
    /// no pose changes.
    template <class Kind>
    Kind& as() {
      drop_pose_changes(0);
      if (!std::holds_alternative<Kind>(operation)) {
        Kind replacement;
        std::visit(
            [&](auto& replaced) {
              if constexpr (requires { replaced.pose; })
                replacement.pose = std::exchange(replaced.pose, PoseSpec{});
            },
            operation);
        if constexpr (std::is_same_v<Kind, TearOperation>) replacement.stroke.swap(spare_stroke);
        if (auto* tear = std::get_if<TearOperation>(&operation)) tear->stroke.swap(spare_stroke);
        operation = std::move(replacement);
      }
      return std::get<Kind>(operation);
    }

    /// Adds a pose change to the entry's stroke, in the memory of one that was dropped.
    void add_pose_change(std::uint32_t blade, const ModelPose& pose);
    /// Drops the pose changes of a stroke after the first `count`; their memory is kept.
    void drop_pose_changes(std::size_t count) noexcept;

    Stroke spare_stroke;
    std::vector<TearOperation::PoseChange> spare_pose_changes;
  };

  /// Reserves memory for this many operations, and for the lips that all of them may open.
  /// Afterwards has_room() is false when the limit is reached.
  /// @param pose  a pose of the size of those that will be recorded.
  void limit_to(std::size_t operations, std::size_t lips, const ModelPose& pose);
  [[nodiscard]] bool has_room() const { return limit_ == kUnlimited || done_.size() < limit_; }

  /// The entry that push() will add, to be filled in.
  [[nodiscard]] Entry& next();
  /// The same entry, once it is filled in.
  [[nodiscard]] Entry& filled() { return *spare_.back(); }
  /// Reserves memory so that a push() with this many lips and rim points does not fail.
  void make_room_for(std::size_t lips, std::size_t rim_points);
  /// Adds next() as the most recent entry and clears the redo stack.
  /// @param borders  the borders that the operation opened; redo() reports them again.
  void push(const OpenedBorders& borders);

  [[nodiscard]] bool is_empty() const { return done_.empty() && undone_.empty(); }
  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& done() const { return done_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& undone() const { return undone_; }
  /// The lips and rim points with which an entry was pushed. Valid on the redo stack too.
  [[nodiscard]] std::span<const LipPair> lips_of(const Entry& entry) const {
    return std::span(borders_.lips).subspan(entry.lips.first, entry.lips.count);
  }
  [[nodiscard]] std::span<const RimPoint> rim_points_of(const Entry& entry) const {
    return std::span(borders_.rim_points).subspan(entry.rim_points.first, entry.rim_points.count);
  }
  /// Moves the entry that an equal model has undone last to the top of the redo stack. @throws
  /// std::bad_alloc, with nothing changed
  void adopt_undone(History& from);
  /// Reverts adopt_undone().
  void give_back(History& to) noexcept;
  /// Clears the redo stack. There must be room, as after adopt_undone() and next().
  void forget_undone() noexcept;
  /// Drops memory that is kept for later entries.
  void shrink() noexcept;
  /// Moves the entries of another history into this empty one, which make_room_for() prepared.
  void adopt(History& from) noexcept;
  void make_room_for(const History& to_adopt);
  void add_to(MemoryUse& use) const;
  void make_room_to_undo() {
    if (undone_.size() == undone_.capacity()) undone_.reserve(2 * undone_.size() + 8);
  }
  /// Exchanges what undo() is about to write for memory that an operation dropped from the redo
  /// stack had, unless it has memory itself.
  void give_memory_to(SurfaceEditor::Redo& redo) noexcept {
    if (!redo.tails.meshes.empty() || spare_redos_.empty()) return;
    redo = std::move(spare_redos_.back());
    spare_redos_.pop_back();
  }
  /// Move the most recent entry to the redo stack and back.
  void move_to_undone() { move_last(done_, undone_); }
  void move_to_done() { move_last(undone_, done_); }

 private:
  using Entries = std::vector<std::unique_ptr<Entry>>;
  static void move_last(Entries& from, Entries& to);
  void give_long_stroke(Entry& entry);
  void take_long_stroke(Entry& entry);
  /// The place of the next entry's borders: after those of all entries that are done.
  [[nodiscard]] IndexRange next_lips() const;
  [[nodiscard]] IndexRange next_rim_points() const;

  Entries done_, undone_, spare_;
  std::vector<SurfaceEditor::Redo> spare_redos_;  ///< Of operations dropped from the redo stack.
  /// Borders of all entries: first those that are done, oldest first, then those of the redo stack,
  /// from its top down.
  OpenedBorders borders_;
  /// Memory for a long stroke while no entry is being filled in; otherwise for a short one. Only
  /// in a history of limited length.
  Stroke blades_;
  static constexpr std::size_t kUnlimited = ~std::size_t{0};
  std::size_t limit_ = kUnlimited;
};

/// Stores a pose in a pose description. Memory of a pose that it held before is reused.
void assign_pose(const ModelPose& pose, PoseSpec& spec);

}  // namespace sunder::tear
