#pragma once

#include <sunder/operation/operation.h>
#include <sunder/particles/soft_body.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/report.h>
#include <sunder/tear/tear_stroke.h>

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace sunder {

class CharacterAsset;

/// Names an instance of a Scene. The name of a destroyed instance never becomes that of another
/// one.
struct InstanceId {
  std::uint32_t slot = kNone;
  std::uint32_t generation = 0;

  bool operator==(const InstanceId&) const = default;
};

// Commands act in the pose that the instance has in the frame in which they are applied.

struct TearCommand {
  Stroke stroke;
  TearOptions options;
};
/// Starts a stroke that later commands extend, frame by frame.
struct BeginStrokeCommand {
  Blade blade;
  TearOptions options;
  StrokeSampling sampling;
};
struct ExtendStrokeCommand {
  Blade blade;
  double seconds = 0.0;  ///< As TearStroke::extend().
};
struct EndStrokeCommand {};
struct CancelStrokeCommand {};
/// Takes a piece off the instance; the result has it as a character of its own.
struct DetachCommand {
  PiecePlace piece;
  DetachOptions options;
};
struct UndoCommand {};
struct RedoCommand {};

/// An operation on an instance. A PlaneCut cuts, a Bore drills, a Weld closes wounds, a
/// Suture sews them, a WeightsOperation assigns new weights to torn vertices.
using SceneCommand =
    std::variant<TearCommand, PlaneCut, Bore, BeginStrokeCommand, ExtendStrokeCommand,
                 EndStrokeCommand, CancelStrokeCommand, DetachCommand, UndoCommand, RedoCommand,
                 WeightsOperation, Weld, Suture>;

/// How the tissue of a piece moved when it was detached.
struct PieceTissue {
  std::vector<ParticleInfluences> influences;  ///< One per point of DetachedPiece::points.
  std::vector<PointMotion> particles;          ///< The motion of each, by which motion_at() works.
};

/// The number of a command, ascending in the order of Scene::submit().
using CommandId = std::uint64_t;

/// The outcome of a command.
struct CommandResult {
  CommandId command = 0;
  InstanceId instance;
  Status status;      ///< A command that failed changed nothing.
  TearReport report;  ///< Empty for a command that failed, and for undo and redo.
  std::shared_ptr<const DetachedPiece> piece;  ///< Of a DetachCommand that succeeded.
  /// The motion of that piece if it was soft, for CharacterInstance::inherit_motion().
  std::shared_ptr<const PieceTissue> tissue;
  /// An asset of that piece, if the command ran in the background: with the options of the
  /// instance's, without coarser levels. Null without enough memory for it.
  std::shared_ptr<const CharacterAsset> asset;
  std::vector<ChangeRecord> changes;  ///< If CommandOptions::wants_changes.
  /// Whether a command like this one should set CommandOptions::in_background: it ran in the frame
  /// and added or retired more than kElementsOfFrame vertices and triangles.
  bool advises_background = false;
};

/// Vertices and triangles that a command may add and retire in a frame of 90 Hz beside the rest of
/// its work: about two milliseconds of a soft instance. docs/frame.md.
inline constexpr std::uint32_t kElementsOfFrame = 1000;

struct CommandOptions {
  bool wants_changes = false;  ///< Whether the result lists the changes, for engines that mirror
                               ///< births and lips.
  /// For tears, cuts, bores, pieces and weights that take longer than a frame: runs on another
  /// thread while the instance is drawn as it was, and is swapped in by a later update, which only
  /// exchanges what was prepared. It acts in the pose of the update that takes it. Later commands
  /// of the instance wait for it, but not for a refit. Those of strokes do not wait: they are
  /// applied before it, and it runs again on what they leave.
  bool in_background = false;
};

}  // namespace sunder
