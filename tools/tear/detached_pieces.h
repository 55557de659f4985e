#pragma once

#include <sunder/io/character_file.h>
#include <sunder/tear/detached_piece.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/messages/exit_code.h"
#include "tools/messages/messages.h"

namespace sunder::tools {

using FinishPiece = std::function<std::shared_ptr<const Character>(const DetachedPiece&)>;

/// Keeps the pieces that a log detaches, for --pieces. Undo and redo of the log count.
class DetachedPieces {
 public:
  /// @param prefix     begins the names of the pieces' files.
  /// @param extension  ends them, and tells their format: ".glb".
  DetachedPieces(PieceMotion motion, std::string prefix, std::string extension)
      : prefix_(std::move(prefix)), extension_(std::move(extension)) {
    options_.motion = motion;
  }

  /// Applies an operation and keeps the piece that it detaches.
  Result<TearReport> apply(const Operation& operation, TornModel& model);

  /// The files of all pieces that are detached, in order: PREFIX1.glb, PREFIX2.glb ….
  [[nodiscard]] std::vector<std::string> files() const;

  /// Writes them.
  /// @param finish   makes the character that is written of a piece.
  /// @param written  the names of what was written.
  /// @return ok, or the exit code of the failure, which was reported.
  [[nodiscard]] ExitCode write(const LoadedCharacter& loaded, const SaveOptions& save,
                               const FinishPiece& finish, const Messages& messages,
                               std::vector<std::string>& written) const;

 private:
  using Step = std::optional<DetachedPiece>;  ///< Empty for an operation of another kind.
  void keep(const Operation& operation, Step piece, bool is_recorded);

  DetachOptions options_;
  std::string prefix_, extension_;
  std::vector<Step> done_, undone_;  ///< As the history of the model.
};

}  // namespace sunder::tools
