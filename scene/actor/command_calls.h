#pragma once

#include <sunder/scene/character_instance.h>
#include <sunder/scene/scene_command.h>

#include <optional>

namespace sunder::scene {

/// The results of a DetachCommand, as CommandResult has them.
struct DetachedParts {
  std::shared_ptr<const DetachedPiece> piece;
  std::shared_ptr<const PieceTissue> tissue;
  std::shared_ptr<const CharacterAsset> asset;
};

/// Applies a command to an instance in a pose. @param changes  optional; records are appended.
/// @throws std::bad_alloc
/// @param piece  written by a DetachCommand.
[[nodiscard]] Result<TearReport> apply_command(const SceneCommand& command, const ModelPose& pose,
                                               CharacterInstance& instance,
                                               std::vector<ChangeRecord>* changes,
                                               DetachedParts& piece);

/// A command as an operation that runs in the background; none for a command that is about a stroke
/// or the history. @throws std::bad_alloc
[[nodiscard]] std::optional<Operation> operation_of(const SceneCommand& command,
                                                    const ModelPose& pose);

}  // namespace sunder::scene
