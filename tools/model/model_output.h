#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>
#include <memory>

#include "tools/messages/messages.h"

namespace sunder::tools {

/// Whether a model is written as USD rather than GLB: its file ends in .usda or .usdz.
[[nodiscard]] bool is_usd(const std::filesystem::path& file);

/// Writes a changed model: as save_glb(), or as save_usd() by the file's extension, with a warning
/// if images are left out.
[[nodiscard]] Status write_changed(const std::filesystem::path& file, const Character& character,
                                   const LoadedCharacter& loaded, const SaveOptions& save,
                                   const Messages& messages);

/// Writes a model that is no change of a loaded one, with the materials of a document or, without
/// one, plain ones: by the file's extension.
[[nodiscard]] Status write_new(const std::filesystem::path& file, const Character& character,
                               const std::shared_ptr<const SourceDocument>& materials,
                               const SaveOptions& save, const Messages& messages);

}  // namespace sunder::tools
