#pragma once

#include <sunder/tear/torn_model.h>

#include <mutex>
#include <new>

#include "tear/history.h"
#include "tear/operation/stroke_tearing.h"
#include "tear/posed/workpiece.h"
#include "tear/surface/capacity_exceeded.h"
#include "tear/surface/surface_editor.h"
#include "tear/weights/assign_weights.h"
#include "tear/weights/refit_task.h"

namespace sunder {

/// The state of a TornModel, and the transaction around each of its operations.
struct TornModel::State {
  State(std::shared_ptr<const Character> from, const TornCapacity& of);

  /// The results of one call of an operation.
  struct Call {
    TearReport report;
    tear::OpenedBorders& borders;
  };
  /// Runs `work(Call&) -> Status` and describes the changes. If it fails, or memory or capacity
  /// runs out, all changes are rolled back. New points keep the posed positions at which they were
  /// made until the pose is set again.
  /// @param of_points  options for the weights of the points that the call creates.
  /// @param is_cut  report all pieces if there are several.
  /// @param conclude  conclude(report) runs last. It may throw as `work` may; nothing fails after
  ///         it.
  template <class Work, class Conclude>
  Result<TearReport> call(Work work, const WeightOptions& of_points, ChangeRecord* change,
                          bool is_cut, Conclude conclude) {
    begin_call();
    Call call{{}, borders_of_call_};
    try {
      if (Status status = work(call); !status) {
        take_back();
        return status;
      }
      end_call(call, of_points, change, is_cut);
      make_room_for_borders();
      conclude(call.report);
      keep_borders();
    } catch (const tear::CapacityExceeded& exceeded) {
      take_back();
      return no_room(exceeded);
    } catch (const std::bad_alloc&) {
      take_back();
      return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
    }
    return std::move(call.report);
  }

  /// Counts the elements added and retired since `begin`, and finds the pieces that came free.
  void count(const tear::EditLog::Mark& begin, bool is_cut, TearReport& report);

  /// Begins an operation. @return the mark to roll back to.
  /// @param keeps_opened  keep a list of the borders that the operation opens.
  [[nodiscard]] tear::EditLog::Mark begin_operation(bool keeps_opened) {
    editor.opened_edges.begin(keeps_opened);
    borders_.clear();
    return editor.mark();
  }

  /// @return an error while a stroke is under way, or if there is no room for another operation.
  [[nodiscard]] Status may_begin() const;
  [[nodiscard]] Status no_room(const tear::CapacityExceeded& exceeded) const;
  /// Sets the pose in which points are evaluated. On failure the old pose stays.
  [[nodiscard]] Status stand_in(const ModelPose& pose);
  /// Records the operation that began at `begin` and is described by history.next(), so that it can
  /// be undone. An operation that changed nothing is not recorded.
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

  std::shared_ptr<const Character> source;
  TornCapacity capacity;
  WeightOptions weights;  ///< Options for operations that have none of their own.
  Character character;
  tear::SurfaceEditor editor;
  tear::PosedPoints posed;
  ModelPose pose;  ///< The pose of `posed`.
  bool has_stroke = false;
  tear::StrokeTearing tearing;  ///< The stroke under way, or the last one.
  tear::History history;
  std::vector<std::weak_ptr<tear::RefitTask>> refits;  ///< All refits that were submitted.
  /// Diagonal of the bounding box of the source in the rest pose. Computed by the first call,
  /// O(vertices). Thread-safe.
  [[nodiscard]] double rest_diagonal() const;

  template <class Work>
  Result<TearReport> call(Work work, const WeightOptions& of_points, ChangeRecord* change,
                          bool is_cut = false) {
    return call(work, of_points, change, is_cut, [](const TearReport&) {});
  }

 private:
  void begin_call();
  void make_room_for_borders();
  void keep_borders();
  void end_call(Call& call, const WeightOptions& of_points, ChangeRecord* change, bool is_cut);
  void take_back();

  tear::EditLog::Mark begin_of_call_;
  /// Borders of the call under way, and of the earlier calls of the same operation.
  tear::OpenedBorders borders_of_call_, borders_;
  mutable std::once_flag has_rest_diagonal_;
  mutable double rest_diagonal_ = 0;
};

/// The checks of a stroke that do not need the surface.
[[nodiscard]] Status validate_blade(const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_options(const TearOptions& options);
[[nodiscard]] Status validate_weights(const WeightOptions& options);
/// The options to record with an operation: none if they are the defaults of a new model.
[[nodiscard]] inline std::optional<WeightOptions> recorded(const WeightOptions& options) {
  return options == WeightOptions{} ? std::nullopt : std::optional(options);
}

}  // namespace sunder
