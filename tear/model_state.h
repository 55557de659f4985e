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

/// What a TornModel is made of, and the frame around each of its operations.
struct TornModel::State {
  State(std::shared_ptr<const Character> from, const TornCapacity& of);

  /// What one call of an operation did.
  struct Call {
    TearReport report;
    tear::OpenedBorders& borders;
  };
  /// Runs `work(Call&) -> Status` and describes what it did; where memory or capacity runs out
  /// takes everything back. Points keep the places where they were found until the pose is set
  /// anew.
  /// @param of_points  the weights that the points get which it made.
  /// @param is_cut  all pieces are reported, if there are several.
  /// @param conclude  conclude(report): may throw as the rest may; nothing fails after it.
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

  /// Fills in what was added and retired since `begin`, and what came free.
  void count(const tear::EditLog::Mark& begin, bool is_cut, TearReport& report);

  /// Where the operation that begins now begins.
  /// @param keeps_opened  it will ask which borders it opened.
  [[nodiscard]] tear::EditLog::Mark begin_operation(bool keeps_opened) {
    editor.opened_edges.begin(keeps_opened);
    borders_.clear();
    return editor.mark();
  }

  /// Refuses while a stroke is under way, and where there is no room for another operation.
  [[nodiscard]] Status may_begin() const;
  [[nodiscard]] Status no_room(const tear::CapacityExceeded& exceeded) const;
  /// Makes `pose` the one in which points are looked up. On failure the old one stays.
  [[nodiscard]] Status stand_in(const ModelPose& pose);
  /// Ends an operation that began at `begin`, and whose description is history.next(): it can be
  /// taken back from now on, unless it did nothing.
  void record(const tear::EditLog::Mark& begin);

  /// Makes a WeightsOperation say which operations it is about, or refuses it.
  [[nodiscard]] Status resolve(WeightsOperation& wanted) const;
  /// The vertices that these operations appended.
  [[nodiscard]] tear::VertexRanges vertices_of(const WeightsOperation& resolved) const;
  /// Gives points other weights, as an operation of its own.
  [[nodiscard]] Status reweigh(const WeightsOperation& resolved,
                               const tear::WeightAssignment& assignment, ChangeRecord* change);

  /// To be called when an operation was undone.
  void cancel_refits_of(std::uint64_t serial) const;

  [[nodiscard]] tear::Workpiece workpiece() { return {editor, posed}; }

  std::shared_ptr<const Character> source;
  TornCapacity capacity;
  WeightOptions weights;  ///< Of operations that do not say.
  Character character;
  tear::SurfaceEditor editor;
  tear::PosedPoints posed;
  ModelPose pose;  ///< Of `posed`.
  bool has_stroke = false;
  tear::StrokeTearing tearing;  ///< The stroke under way, or the last one.
  tear::History history;
  std::vector<std::weak_ptr<tear::RefitTask>> refits;  ///< That were submitted.
  /// Of the source in the rest pose: the first time it is asked for, O(vertices). May be asked for
  /// by several threads.
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
  tear::OpenedBorders borders_of_call_,
      borders_;  ///< Of the call under way, and of the operation's calls before it.
  mutable std::once_flag has_rest_diagonal_;
  mutable double rest_diagonal_ = 0;
};

/// What of a stroke can be said before the surface is looked at.
[[nodiscard]] Status validate_blade(const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_options(const TearOptions& options);
[[nodiscard]] Status validate_weights(const WeightOptions& options);
/// How an operation is recorded: without what a model does that was told nothing.
[[nodiscard]] inline std::optional<WeightOptions> recorded(const WeightOptions& options) {
  return options == WeightOptions{} ? std::nullopt : std::optional(options);
}

}  // namespace sunder
