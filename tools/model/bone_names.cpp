#include "tools/model/bone_names.h"

#include <string>

#include "tools/messages/json_file.h"

namespace sunder::tools {

Result<std::vector<BoneNames>> read_bone_names(const std::filesystem::path& file) {
  const Result<Json> pairs = read_json_object(file);
  if (!pairs) return pairs.error();
  std::vector<BoneNames> names;
  for (const auto& [target, source] : pairs->items()) {
    if (!source.is_string())
      return Status::failure(StatusCode::malformed_file, kNone,
                             "'%.80s': expected the name of a bone of the source", target.c_str());
    names.push_back({target, source.get<std::string>()});
  }
  return names;
}

}  // namespace sunder::tools
