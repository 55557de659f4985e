#include "tools/model/model_output.h"

#include <sunder/io/usd_file.h>

#include "io/internal/copied_materials.h"
#include "io/internal/lower_extension.h"
#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

Status write_usd(const std::filesystem::path& file, const Character& character,
                 const LoadedCharacter& loaded, const SaveOptions& save, const Messages& messages) {
  const Result<std::uint32_t> left_out = save_usd(file, character, loaded, save);
  if (!left_out) return left_out.error();
  if (*left_out > 0)
    messages.warn(
        printed("%s: %u image%s left out: missing, too large, or neither PNG nor JPEG, which are "
                "what USD knows",
                file.c_str(), *left_out, *left_out == 1 ? " is" : "s are"));
  return {};
}

}  // namespace

bool is_usd(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".usda" || extension == ".usdz";
}

Status write_changed(const std::filesystem::path& file, const Character& character,
                     const LoadedCharacter& loaded, const SaveOptions& save,
                     const Messages& messages) {
  return is_usd(file) ? write_usd(file, character, loaded, save, messages)
                      : save_glb(file, character, loaded, save);
}

Status write_new(const std::filesystem::path& file, const Character& character,
                 const std::shared_ptr<const SourceDocument>& materials, const SaveOptions& save,
                 const Messages& messages) {
  if (is_usd(file)) return write_usd(file, character, {nullptr, materials, {}, {}}, save, messages);
  return materials == nullptr ? save_glb(file, character, save)
                              : save_with_materials(file, character, *materials, save);
}

}  // namespace sunder::tools
