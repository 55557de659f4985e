#include "tools/messages/json_file.h"

#include <fstream>
#include <sstream>
#include <utility>

namespace sunder::tools {

Result<Json> read_json_object(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream)
    return Status::failure(StatusCode::file_unreadable, kNone, "this file cannot be read");
  Json json = Json::parse(text.str(), nullptr, false);
  if (!json.is_object())
    return Status::failure(StatusCode::malformed_file, kNone, "the file is not one JSON object");
  return json;
}

}  // namespace sunder::tools
