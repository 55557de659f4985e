#include "tools/model/find_clip.h"

#include "core/internal/nearest_names.h"

namespace sunder::tools {

std::optional<std::uint32_t> find_clip(const Character& character, std::string_view name) {
  std::optional<std::uint32_t> behind_namespace;
  bool is_ambiguous = false;
  for (std::uint32_t i = 0; i < character.clips.size(); ++i) {
    if (character.clips[i].name == name) return i;
    if (without_namespace(character.clips[i].name) != name) continue;
    is_ambiguous = behind_namespace.has_value();
    behind_namespace = i;
  }
  return is_ambiguous ? std::nullopt : behind_namespace;
}

}  // namespace sunder::tools
