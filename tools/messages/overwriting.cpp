#include "tools/messages/overwriting.h"

#include <system_error>

namespace sunder::tools {

bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const std::filesystem::path canonical_a = std::filesystem::weakly_canonical(a, error);
  if (error) return false;
  const std::filesystem::path canonical_b = std::filesystem::weakly_canonical(b, error);
  return !error && canonical_a == canonical_b;
}

std::string overwriting(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs,
                        const std::string& advice) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedFile& output = outputs[i];
    const std::string begin = output.option + " " + output.file.string() + ": would overwrite ";
    for (std::size_t j = 0; j < i; ++j)
      if (is_one_file(output.file, outputs[j].file))
        return begin + "the file of " + outputs[j].option;
    for (const NamedFile& input : inputs)
      if (is_one_file(output.file, input.file))
        return begin + input.option + " " + input.file.string() + advice;
  }
  return {};
}

}  // namespace sunder::tools
