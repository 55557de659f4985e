#include <sunder/io/operation_log.h>

#include "io/gltf/refusal.h"
#include "io/internal/read_input.h"
#include "io/internal/staged_file.h"
#include "io/internal/strict_json.h"

namespace sunder {
namespace {

Result<std::string> read_log(const std::filesystem::path& file) {
  return gltf::without_exceptions<std::string>([&] { return read_input(file, kMaximumJsonBytes); });
}

}  // namespace

Result<std::vector<Operation>> load_operations(const std::filesystem::path& file,
                                               const Character* model) {
  const Result<std::string> text = read_log(file);
  if (!text) return text.error();
  return parse_operations(*text, model);
}

Result<std::vector<LoggedOperation>> load_aimed_operations(const std::filesystem::path& file,
                                                           const Character* model) {
  const Result<std::string> text = read_log(file);
  if (!text) return text.error();
  return parse_aimed_operations(*text, model);
}

Status save_operations(const std::filesystem::path& file, std::span<const Operation> operations) {
  const Result<std::string> text = format_operations(operations);
  if (!text) return text.error();
  return write_file(file, std::as_bytes(std::span<const char>(*text)));
}

}  // namespace sunder
