#pragma once

#include <sunder/tear/torn_model.h>

#include <functional>

#include "tear/surface_editor.h"
#include "tear/workpiece.h"

namespace sunder {

/// What a TornModel is made of, and the frame around each of its operations.
struct TornModel::State {
  explicit State(std::shared_ptr<const Character> from);

  /// What one call of an operation works on: a point to come back to, and what the call did.
  struct Call {
    tear::SurfaceEditor::Mark begin;
    TearReport report;
    ChangeRecord change;
  };
  /// Runs `work` and describes what it did; where memory runs out takes everything back. Points keep the places where they were
  /// found until the pose is set anew.
  /// @param is_cut  all pieces are reported, if there are several.
  Result<TearReport> call(const std::function<Status(Call&)>& work, ChangeRecord* change, bool is_cut = false);

  /// Fills in what was added and retired since `begin`, and what came free.
  void count(const tear::SurfaceEditor::Mark& begin, bool is_cut, TearReport& report);

  /// Where the operation that begins now begins.
  /// @param keeps_opened  it will ask which borders it opened.
  [[nodiscard]] tear::SurfaceEditor::Mark begin_operation(bool keeps_opened) {
    editor.begin_opening(keeps_opened);
    return editor.mark();
  }

  /// Refuses while a stroke is under way.
  [[nodiscard]] Status may_begin() const;
  /// Makes `pose` the one in which points are looked up. On failure the old one stays.
  [[nodiscard]] Status stand_in(const ModelPose& pose);
  /// Ends an operation that began at `begin`: it can be taken back from now on, unless it did nothing.
  void record(Operation operation, const tear::SurfaceEditor::Mark& begin);

  [[nodiscard]] tear::Workpiece workpiece() { return {editor, posed}; }

  struct Done {
    Operation operation;
    tear::SurfaceEditor::Mark begin;
  };
  struct Undone {
    Operation operation;
    tear::SurfaceEditor::Redo redo;
  };

  std::shared_ptr<const Character> source;
  Character character;
  tear::SurfaceEditor editor;
  tear::PosedPoints posed;
  ModelPose pose;  ///< Of `posed`.
  bool has_stroke = false;
  std::vector<Done> done;
  std::vector<Undone> undone;  ///< The one to do again last.
};

/// What of a stroke can be said before the surface is looked at.
[[nodiscard]] Status validate_blade(const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_turn(const Blade& before, const Blade& blade, std::uint32_t index);
[[nodiscard]] Status validate_options(const TearOptions& options);

}  // namespace sunder
