#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>
#include <new>

#include "core/internal/out_of_memory.h"
#include "tear/model/history.h"
#include "tear/model/packed_operations.h"
#include "tear/operation/ongoing_stroke.h"
#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"
#include "tear/surface/capacity_exceeded.h"
#include "tear/surface/surface_editor.h"
#include "tear/weights/assign_weights.h"
#include "tear/weights/refit_task.h"

namespace sunder {

/// The state of a TornModel, and the transaction around each of its operations.
struct TornModel::State {
  /// @param surface  of the character, as build_surface() makes it.
  /// @param trees    of the character, kept by reference.
  State(std::shared_ptr<const Character> from, tear::Surface surface,
        const tear::SourceTrees& trees, const TornCapacity& of,
        std::shared_ptr<const tear::SurfaceCells> cells = nullptr);

  /// Moves all that the operations made into a compact form. Afterwards nothing is torn and no
  /// operation is recorded. @throws std::bad_alloc: nothing changes
  [[nodiscard]] std::unique_ptr<tear::PackedOperations> pack();
  /// Restores what pack() returned, in a state in which nothing is torn.
  /// @throws std::bad_alloc: nothing changes
  void unpack(tear::PackedOperations& packed);
  /// Drops all operations. @return false: out of memory; the state is not to be used any more.
  [[nodiscard]] bool reset() noexcept;
  [[nodiscard]] tear::MemoryUse memory_use() const;

  /// How one call of an operation is made and reported.
  struct CallOptions {
    const WeightOptions& weights;    ///< Weights of the points that the call creates.
    ChangeRecord* change = nullptr;  ///< Written where given.
    /// Whether every piece is reported, as by a cut, or only those that came free.
    bool names_all_pieces = false;
    bool is_detachment = false;  ///< Retires a whole component: its vertices are released.
  };

  /// One call of an operation. `work(Outcome&) -> Status` changes the surface (places, imprints,
  /// opens, retires, fills); then new points are weighed, changes counted, pieces found, and the
  /// change record written. If anything fails, everything is taken back. Points keep the places at
  /// which they were found until the pose is set anew.
  /// @param conclude  conclude(report): may throw as the rest may; nothing fails after it.
  template <class Work, class Conclude>
  Result<TearReport> call(const CallOptions& options, Work work, Conclude conclude) {
    begin_call();
    tear::Outcome outcome{{}, borders_.of_call};
    TearReport& report = outcome.report;
    try {
      if (Status status = work(outcome); !status) {
        take_back();
        return status;
      }
      drop_removed_lips();
      report.weights = weigh_points_since(begin_of_call_, options.weights);
      count_changes_since(begin_of_call_, report);
      report.pieces = find_pieces_of_call(options.names_all_pieces, outcome);
      if (options.change != nullptr) describe_call(*options.change, options.is_detachment);
      make_room_for_borders();
      conclude(report);
      keep_borders();
    } catch (const tear::CapacityExceeded& exceeded) {
      take_back();
      return no_room(exceeded);
    } catch (const std::bad_alloc&) {
      take_back();
      return out_of_memory();
    }
    return std::move(report);
  }

  /// How an operation that is one call is made.
  struct OperationOptions {
    const ModelPose& pose;
    const WeightOptions& weights;
    ChangeRecord* change = nullptr;
    bool keeps_opened = false;  ///< Whether it asks which borders it opened.
    bool names_all_pieces = false;
    bool is_detachment = false;
  };

  /// An operation that is one call, as a transaction: enters the pose, writes the history's next
  /// entry, does the work, and records the entry. A failure leaves the model as it was.
  /// @param write_entry  write_entry(Operation&): everything but the pose.
  /// @param work         work(Outcome&).
  template <class Operation, class WriteEntry, class Work>
  Result<TearReport> perform(const OperationOptions& options, WriteEntry write_entry, Work work) {
    if (Status status = stand_in(options.pose); !status) return status;
    const tear::EditLog::Mark begin = begin_operation(options.keeps_opened);
    const auto write_and_work = [&](tear::Outcome& outcome) -> Status {
      auto& entry = history.next().as<Operation>();
      tear::assign_pose(options.pose, entry.pose);
      write_entry(entry);
      work(outcome);
      return {};
    };
    auto report =
        call({options.weights, options.change, options.names_all_pieces, options.is_detachment},
             write_and_work, [](const TearReport&) {});
    if (report) record(begin);
    return report;
  }

  /// Gives the points that were made since `begin` their weights.
  [[nodiscard]] WeightReport weigh_points_since(const tear::EditLog::Mark& begin,
                                                const WeightOptions& options);
  /// Fills in what was added and retired since `begin`.
  void count_changes_since(const tear::EditLog::Mark& begin, TearReport& report) const;
  [[nodiscard]] TornPieces find_pieces_since(const tear::EditLog::Mark& begin);

  /// Begins an operation. @return the mark to roll back to.
  /// @param keeps_opened  keep a list of the borders that the operation opens.
  [[nodiscard]] tear::EditLog::Mark begin_operation(bool keeps_opened) {
    editor.opened_edges.begin(keeps_opened);
    borders_.of_operation.clear();
    return editor.mark();
  }

  /// @return an error while a stroke is under way, or if there is no room for another operation.
  [[nodiscard]] Status may_begin() const;
  [[nodiscard]] Status no_room(const tear::CapacityExceeded& exceeded) const;
  /// Sets the pose in which points are evaluated. On failure the old pose stays. Fails only for a
  /// pose that does not fit, once the model stood in one.
  [[nodiscard]] Status stand_in(const ModelPose& pose);
  /// Records the operation that began at `begin` and is described by history.filled(), so that it
  /// can be undone. An operation that changed nothing is not recorded.
  void record(const tear::EditLog::Mark& begin);

  /// Validates a WeightsOperation and makes its range of operations explicit.
  [[nodiscard]] Status resolve(WeightsOperation& wanted) const;
  /// The vertices that the operations of that range appended.
  [[nodiscard]] tear::VertexRanges vertices_of(const WeightsOperation& resolved) const;
  /// Assigns other weights to points, as an operation of its own.
  [[nodiscard]] Status reweigh(const WeightsOperation& resolved,
                               const tear::WeightAssignment& assignment, ChangeRecord* change);

  /// Cancels the refits of an operation that was undone.
  void cancel_refits_of(std::uint64_t serial) const;

  [[nodiscard]] tear::Workpiece workpiece() { return {editor, posed}; }
  /// Takes back all changes since the last call() began. Does not allocate.
  void take_back();

  std::shared_ptr<const Character> source;
  TornCapacity capacity;
  WeightOptions weights;  ///< Options for operations that have none of their own.
  Character character;
  tear::SurfaceEditor editor;
  tear::PosedPoints posed;
  ModelPose pose;  ///< The pose of `posed`.
  bool has_stroke = false;
  tear::OngoingStroke stroke;         ///< The stroke under way, or the last one.
  tear::OngoingStroke stroke_before;  ///< As it was before a call, in case that fails.
  tear::History history;
  std::vector<std::weak_ptr<tear::RefitTask>> refits;  ///< All refits that were submitted.

 private:
  [[nodiscard]] tear::History new_history() const;
  /// Each pair has two new vertices at least, except at the ends of a tear.
  [[nodiscard]] std::size_t most_lips() const {
    return capacity.vertices / 2 + 2 * std::size_t{capacity.operations};
  }
  void begin_call();
  [[nodiscard]] TornPieces find_pieces_of_call(bool names_all, const tear::Outcome& outcome);
  void make_room_for_borders();
  /// Forgets lips of the call whose walls a later step of it removed.
  void drop_removed_lips();
  void keep_borders();
  void describe_call(ChangeRecord& change, bool is_detachment);

  tear::EditLog::Mark untorn_;  ///< Before all operations.
  tear::EditLog::Mark begin_of_call_;
  /// Borders of the call under way, and of the earlier calls of the same operation.
  struct {
    tear::OpenedBorders of_call, of_operation;
  } borders_;
};

/// The checks of a stroke that do not need the surface.
[[nodiscard]] Status validate_blade(const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_weights(const WeightOptions& options);
[[nodiscard]] Status validate_options(const TearOptions& options);
/// A whole stroke: first the number of blades, then the options, then blade after blade.
[[nodiscard]] Status validate_tear(std::span<const Blade> stroke, const TearOptions& options);
/// The options to record with an operation: none if they are the defaults of a new model, and of
/// this one, so that the operation is the same in a new model and in one with the same defaults.
[[nodiscard]] inline std::optional<WeightOptions> recorded(const WeightOptions& options,
                                                           const WeightOptions& of_model) {
  return options == WeightOptions{} && of_model == options ? std::nullopt : std::optional(options);
}

}  // namespace sunder
