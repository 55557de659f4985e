#include "tools/messages/json_file.h"

#include <string>

#include "io/internal/read_input.h"
#include "io/internal/strict_json.h"

namespace sunder::tools {

Result<Json> read_json_object(const std::filesystem::path& file) {
  const Result<std::string> text = read_input(file, kMaximumJsonBytes);
  if (!text) return text.error();
  Result<Json> json = parse_strict_json(*text);
  if (json && !json->is_object())
    return Status::failure(StatusCode::malformed_file, kNone, "the file is not one JSON object");
  return json;
}

}  // namespace sunder::tools
