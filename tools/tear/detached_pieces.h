#pragma once

#include <sunder/io/character_file.h>
#include <sunder/tear/detached_piece.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/messages/exit_code.h"
#include "tools/messages/overwriting.h"

namespace sunder::tools {

/// Keeps the pieces that a log detaches, for --pieces. Undo and redo of the log count.
class DetachedPieces {
 public:
  explicit DetachedPieces(PieceMotion motion) { options_.motion = motion; }

  /// Applies an operation and keeps the piece that it detaches.
  Result<TearReport> apply(const Operation& operation, TornModel& model);

  /// Writes the pieces of all detachments that are done, in order: PREFIX1.glb, PREFIX2.glb ….
  /// @param inputs  files that must not be overwritten. @param written  the names are appended.
  /// @return ok, or the exit code of the failure, which was reported.
  [[nodiscard]] ExitCode write(const std::string& prefix, const LoadedCharacter& loaded,
                               const SaveOptions& save, const std::vector<NamedFile>& inputs,
                               std::vector<std::string>& written) const;

 private:
  using Step = std::optional<DetachedPiece>;  ///< Empty for an operation of another kind.
  void keep(const Operation& operation, Step piece, bool is_recorded);

  DetachOptions options_;
  std::vector<Step> done_, undone_;  ///< As the history of the model.
};

}  // namespace sunder::tools
