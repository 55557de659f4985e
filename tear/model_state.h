#pragma once

#include <sunder/tear/torn_model.h>

#include <new>

#include "tear/capacity_exceeded.h"
#include "tear/history.h"
#include "tear/stroke_tearing.h"
#include "tear/surface_editor.h"
#include "tear/workpiece.h"

namespace sunder {

/// What a TornModel is made of, and the frame around each of its operations.
struct TornModel::State {
  State(std::shared_ptr<const Character> from, const TornCapacity& of);

  /// What one call of an operation did.
  struct Call {
    TearReport report;
    std::vector<LipPair>& lips;
  };
  /// Runs `work(Call&) -> Status` and describes what it did; where memory or capacity runs out takes everything back. Points keep
  /// the places where they were found until the pose is set anew.
  /// @param is_cut  all pieces are reported, if there are several.
  template <class Work>
  Result<TearReport> call(Work work, ChangeRecord* change, bool is_cut = false) {
    begin_call();
    Call call{{}, lips};
    try {
      if (Status status = work(call); !status) {
        take_back();
        return status;
      }
      end_call(call, change, is_cut);
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
  void count(const tear::SurfaceEditor::Mark& begin, bool is_cut, TearReport& report);

  /// Where the operation that begins now begins.
  /// @param keeps_opened  it will ask which borders it opened.
  [[nodiscard]] tear::SurfaceEditor::Mark begin_operation(bool keeps_opened) {
    editor.begin_opening(keeps_opened);
    return editor.mark();
  }

  /// Refuses while a stroke is under way, and where there is no room for another operation.
  [[nodiscard]] Status may_begin() const;
  [[nodiscard]] Status no_room(const tear::CapacityExceeded& exceeded) const;
  /// Makes `pose` the one in which points are looked up. On failure the old one stays.
  [[nodiscard]] Status stand_in(const ModelPose& pose);
  /// Ends an operation that began at `begin`, and whose description is history.next(): it can be taken back from now on, unless it
  /// did nothing.
  void record(const tear::SurfaceEditor::Mark& begin);

  [[nodiscard]] tear::Workpiece workpiece() { return {editor, posed}; }

  std::shared_ptr<const Character> source;
  TornCapacity capacity;
  Character character;
  tear::SurfaceEditor editor;
  tear::PosedPoints posed;
  ModelPose pose;  ///< Of `posed`.
  bool has_stroke = false;
  tear::StrokeTearing tearing;  ///< The stroke under way, or the last one.
  std::vector<LipPair> lips;    ///< Of the call under way.
  tear::History history;

 private:
  void begin_call();
  void end_call(Call& call, ChangeRecord* change, bool is_cut);
  void take_back();

  tear::SurfaceEditor::Mark begin_of_call_;
};

/// What of a stroke can be said before the surface is looked at.
[[nodiscard]] Status validate_blade(const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_options(const TearOptions& options);

}  // namespace sunder
